//! The load cell and the crosstalk between the channels.

use crate::hidden_tank::effect::{Hidden, Row};
use crate::hidden_tank::motion::Motion;
use crate::hidden_tank::plan::Pass;

/// Shown roll [rad] and moment [N m] from the value, the time [s], roll and moment.
type Shown = fn(value: f64, time_s: f64, roll: f64, moment: f64) -> (f64, f64);

/// A load cell without memory, and what leaks between it and the potentiometer.
struct Cell {
    value: f64,
    shown: Shown,
}

impl Cell {
    fn hidden(value: f64, shown: Shown) -> Box<dyn Hidden> {
        Box::new(Self { value, shown })
    }
}

impl Hidden for Cell {
    fn transduce(&self, motion: &mut Motion, _pass: &Pass) {
        for at in 0..motion.roll.len() {
            let (time_s, roll) = (motion.time_s[at], motion.roll[at]);
            (motion.roll[at], motion.moment[at]) =
                (self.shown)(self.value, time_s, roll, motion.moment[at]);
        }
    }
}

/// The moment bends the potentiometer's mount; 0.005 to 0.05 degrees by N m, middle 0.016.
pub(super) const ROLL_FROM_MOMENT: Row = Row {
    id: "instrument.roll_from_moment",
    symbols: &["c [rad/(N m)]"],
    draw: |size, draw, _| vec![size * 0.016_f64.to_radians() * draw.sign()],
    hide: |v| Cell::hidden(v[0], |c, _, roll, moment| (roll + c * moment, moment)),
};

/// The roll leaks into the load cell; 0.1 to 2 N m/rad, middle 0.45.
pub(super) const MOMENT_FROM_ROLL: Row = Row {
    id: "instrument.moment_from_roll",
    symbols: &["c [N m/rad]"],
    draw: |size, draw, _| vec![size * 0.45 * draw.sign()],
    hide: |v| Cell::hidden(v[0], |c, _, roll, moment| (roll, moment + c * roll)),
};

/// Zero of the load cell; 0.05 to 0.5 N m, middle 0.16.
pub(super) const OFFSET: Row = Row {
    id: "instrument.force_offset",
    symbols: &["offset [N m]"],
    draw: |size, draw, _| vec![size * 0.16 * draw.sign()],
    hide: |v| Cell::hidden(v[0], |offset, _, roll, moment| (roll, moment + offset)),
};

/// Drift of that zero from the start of each recording; 0.02 to 0.2 N m in 20 s, middle 0.063.
pub(super) const DRIFT: Row = Row {
    id: "instrument.force_drift",
    symbols: &["drift [N m/s]"],
    draw: |size, draw, _| vec![size * 0.063 / 20.0 * draw.sign()],
    hide: |v| Cell::hidden(v[0], |drift, time_s, roll, moment| (roll, moment + drift * time_s)),
};

/// Gain of the load cell; wrong by 0.2 to 3 %, middle 0.77 %.
pub(super) const GAIN: Row = Row {
    id: "instrument.force_gain",
    symbols: &["error [-]"],
    draw: |size, draw, _| vec![size * 0.0077 * draw.sign()],
    hide: |v| Cell::hidden(v[0], |error, _, roll, moment| (roll, moment * (1.0 + error))),
};
