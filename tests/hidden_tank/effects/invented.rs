//! Effects that no catalogue has, so that a tool must say that it does not know them.

use crate::hidden_tank::effect::{Acting, Hidden, Row, Situation};
use crate::hidden_tank::motion::Motion;
use crate::hidden_tank::plan::Pass;

/// The restoring is modulated at an odd frequency, `K (1 + e cos(w t + p))`; e 3 % in the middle.
pub(super) const MODULATED_RESTORING: Row = Row {
    id: "invented.modulated_restoring",
    symbols: &["e [-]", "w [rad/s]"],
    draw: |size, draw, _| vec![size * 0.03, draw.between(2.0, 5.0)],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let phase = std::f64::consts::TAU * at.pass.chance[0];
            -at.base.restoring * v[0] * (v[1] * at.time_s + phase).cos() * at.roll
        })
    },
};

/// A relay with hysteresis pushes to one side until the roll passes a threshold on the other;
/// 0.1 N m and 3 degrees in the middle.
pub(super) const RELAY: Row = Row {
    id: "invented.relay",
    symbols: &["moment [N m]", "threshold [rad]"],
    draw: |size, draw, _| vec![size * 0.1, draw.between(2.0, 4.0).to_radians()],
    hide: |values| Box::new(Relay { moment: values[0], threshold: values[1] }),
};

struct Relay {
    moment: f64,
    threshold: f64,
}

impl Hidden for Relay {
    fn n_states(&self) -> usize {
        1
    }

    /// `s' = 60 (s - s^3 + 2 phi/(3 sqrt(3) threshold))` has two rests, -1 and 1 about, of which
    /// one vanishes beyond the threshold.
    fn rates(&self, at: &Situation, _acceleration: f64, own: &[f64], out: &mut [f64]) {
        let push = 2.0 / 27.0_f64.sqrt() * (at.roll / self.threshold).clamp(-4.0, 4.0);
        out[0] = 60.0 * (own[0] - own[0].powi(3) + push);
    }

    fn moment(&self, _at: &Situation, own: &[f64]) -> f64 {
        -self.moment * own[0]
    }
}

/// A second decaying mode that the product of roll and roll rate drives.
pub(super) const ODD_MODE: Row = Row {
    id: "invented.odd_mode",
    symbols: &["coupling [-]", "w [rad/s]"],
    draw: |size, draw, _| vec![size, draw.between(2.0, 4.5)],
    hide: |values| Box::new(OddMode { coupling: values[0], frequency: values[1] }),
};

struct OddMode {
    coupling: f64,
    frequency: f64,
}

impl Hidden for OddMode {
    fn n_states(&self) -> usize {
        2
    }

    fn rates(&self, at: &Situation, _acceleration: f64, own: &[f64], out: &mut [f64]) {
        let w = self.frequency;
        out[0] = own[1];
        out[1] = 40.0 * at.roll * at.rate - 0.15 * w * own[1] - w * w * own[0];
    }

    fn moment(&self, at: &Situation, own: &[f64]) -> f64 {
        -self.coupling * at.base.inertia * (0.3 * own[0] + 2.0 * own[0] * at.roll)
    }
}

/// Damping in one quadrant only, rising to starboard: a flap of tape; half of B0 in the middle.
pub(super) const QUADRANT_DAMPING: Row = Row {
    id: "invented.quadrant_damping",
    symbols: &["share of B0 [-]"],
    draw: |size, _, _| vec![size * 0.5],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let opens = at.rate > 0.0 && at.roll > 0.0;
            -v[0] * f64::from(u8::from(opens)) * at.base.b0 * at.rate
        })
    },
};

/// A wiper that sticks at one place of the track, on the way up only, until it is torn loose;
/// 0.3 degrees in the middle.
pub(super) const STICKING_WIPER: Row = Row {
    id: "invented.sticking_wiper",
    symbols: &["width [rad]", "place [rad]"],
    draw: |size, draw, _| vec![size * 0.3_f64.to_radians(), draw.between(-2.5, 2.5).to_radians()],
    hide: |values| Box::new(StickingWiper { width: values[0], place: values[1] }),
};

struct StickingWiper {
    width: f64,
    place: f64,
}

impl Hidden for StickingWiper {
    fn transduce(&self, motion: &mut Motion, _pass: &Pass) {
        let mut before = motion.roll[0];
        for roll in &mut motion.roll {
            let rising = *roll > before;
            before = *roll;
            if rising && (self.place..self.place + self.width).contains(roll) {
                *roll = self.place;
            }
        }
    }
}

/// Somebody knocks at the model three times in a run; 0.3 N m for 0.15 s in the middle.
pub(super) const KNOCKS: Row = Row {
    id: "invented.knocks",
    symbols: &["moment [N m]"],
    draw: |size, _, _| vec![size * 0.3],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let knock = |k: usize| {
                let when_s = 2.0 + 4.0 * (k as f64 + at.pass.chance[k]);
                let side = if at.pass.chance[k + 3] > 0.5 { 1.0 } else { -1.0 };
                side * (-((at.since_start_s - when_s) / 0.075).powi(2)).exp()
            };
            v[0] * (0..3).map(knock).sum::<f64>()
        })
    },
};

/// A part of the damping is lost at some instant of every run; a third of B0 in the middle.
pub(super) const LOST_KEEL: Row = Row {
    id: "invented.lost_keel",
    symbols: &["share of B0 [-]"],
    draw: |size, _, _| vec![size * 0.33],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let lost_s = 3.0 + 4.0 * at.pass.chance[0];
            let lost = 0.5 + 0.5 * ((at.since_start_s - lost_s) / 0.1).tanh();
            v[0] * lost * at.base.b0 * at.rate
        })
    },
};
