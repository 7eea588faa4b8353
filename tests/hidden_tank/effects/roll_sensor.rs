//! The potentiometer: what it makes of the roll angle.

use crate::hidden_tank::effect::{Hidden, Row};
use crate::hidden_tank::instruments::Rows;
use crate::hidden_tank::motion::Motion;
use crate::hidden_tank::plan::{Action, Pass};

/// Shown angle [rad] from the values, the time [s] and the angle [rad].
type Shown = fn(values: &[f64], time_s: f64, roll: f64) -> f64;

/// A potentiometer without memory.
struct Curve {
    values: Vec<f64>,
    shown: Shown,
}

impl Curve {
    fn hidden(values: &[f64], shown: Shown) -> Box<dyn Hidden> {
        Box::new(Self { values: values.to_vec(), shown })
    }
}

impl Hidden for Curve {
    fn transduce(&self, motion: &mut Motion, _pass: &Pass) {
        for (roll, time_s) in motion.roll.iter_mut().zip(&motion.time_s) {
            *roll = (self.shown)(&self.values, *time_s, *roll);
        }
    }
}

/// Zero offset; 0.05 to 0.5 degrees, middle 0.16.
pub(super) const OFFSET: Row = Row {
    id: "instrument.roll_offset",
    symbols: &["offset [rad]"],
    draw: |size, draw, _| vec![size * 0.16_f64.to_radians() * draw.sign()],
    hide: |values| Curve::hidden(values, |v, _, roll| roll + v[0]),
};

/// Drift of the zero from the start of each recording; up to 0.2 degrees in 20 s, middle 0.1.
pub(super) const DRIFT: Row = Row {
    id: "instrument.roll_drift",
    symbols: &["drift [rad/s]"],
    draw: |size, draw, _| vec![size * 0.1_f64.to_radians() / 20.0 * draw.sign()],
    hide: |values| Curve::hidden(values, |v, time_s, roll| roll + v[0] * time_s),
};

/// Independent linearity: an error wave along the track, 0.02 to 0.2 degrees, middle 0.063, of a
/// length of 16 to 30 degrees; nought at rest, where the zero was taken.
pub(super) const NONLINEARITY: Row = Row {
    id: "instrument.roll_nonlinearity",
    symbols: &["error [rad]", "length [rad]", "place [rad]"],
    draw: |size, draw, _| {
        let length = draw.between(16.0, 30.0).to_radians();
        vec![size * 0.063_f64.to_radians(), length, draw.between(0.0, std::f64::consts::TAU)]
    },
    hide: |values| {
        Curve::hidden(values, |v, _, roll| {
            let wave = (std::f64::consts::TAU * roll / v[1] + v[2]).sin();
            roll + v[0] * (wave - v[2].sin())
        })
    },
};

/// Gain; wrong by 0.5 to 3 %, middle 1.2 %.
pub(super) const GAIN: Row = Row {
    id: "instrument.roll_gain",
    symbols: &["error [-]"],
    draw: |size, draw, _| vec![size * 0.012 * draw.sign()],
    hide: |values| Curve::hidden(values, |v, _, roll| roll * (1.0 + v[0])),
};

/// Mains hum; 0.01 to 0.1 degrees, middle 0.032, at 50 Hz as mains keep it.
pub(super) const HUM: Row = Row {
    id: "instrument.hum",
    symbols: &["amplitude [rad]", "frequency [Hz]", "phase [rad]"],
    draw: |size, draw, _| {
        let phase = draw.between(0.0, std::f64::consts::TAU);
        vec![size * 0.032_f64.to_radians(), 50.0 + draw.between(-0.05, 0.05), phase]
    },
    hide: |values| {
        Curve::hidden(values, |v, time_s, roll| {
            roll + v[0] * (std::f64::consts::TAU * v[1] * time_s + v[2]).sin()
        })
    },
};

/// Backlash of the coupling, half width 0.02 to 0.2 degrees, middle 0.063.
pub(super) const BACKLASH: Row = Row {
    id: "instrument.roll_backlash",
    symbols: &["half width [rad]"],
    draw: |size, _, _| vec![size * 0.063_f64.to_radians()],
    hide: |values| Box::new(Backlash(values[0])),
};

struct Backlash(f64);

impl Hidden for Backlash {
    fn transduce(&self, motion: &mut Motion, _pass: &Pass) {
        let mut wiper = motion.roll[0];
        for roll in &mut motion.roll {
            wiper = wiper.clamp(*roll - self.0, *roll + self.0);
            *roll = wiper;
        }
    }
}

/// Low-pass filter of one pole; 2 to 50 ms, middle 10.
pub(super) const LAG: Row = Row {
    id: "instrument.roll_lag",
    symbols: &["tau [s]"],
    draw: |size, _, _| vec![size * 0.01],
    hide: |values| Box::new(Lag(values[0])),
};

struct Lag(f64);

impl Hidden for Lag {
    fn transduce(&self, motion: &mut Motion, _pass: &Pass) {
        // Exact for an input that runs straight between grid points.
        let kept = (-motion.step_s / self.0).exp();
        let ramp = 1.0 - (1.0 - kept) * self.0 / motion.step_s;
        let (mut shown, mut before) = (motion.roll[0], motion.roll[0]);
        for roll in &mut motion.roll {
            let rise = *roll - before;
            shown = before + (shown - before) * kept + rise * ramp;
            before = *roll;
            *roll = shown;
        }
    }
}

/// Coarse steps, from a converter of 12 bits to a wound wire: 0.084 to 0.3 degrees, middle 0.12.
pub(super) const QUANTISATION: Row = Row {
    id: "instrument.roll_quantisation",
    symbols: &["step [rad]"],
    draw: |size, _, _| vec![size * 0.12_f64.to_radians()],
    hide: |values| Box::new(Steps(values[0])),
};

struct Steps(f64);

impl Hidden for Steps {
    fn spoil(&self, rows: &mut Rows, _pass: &Pass) {
        let step_deg = self.0.to_degrees();
        for roll in &mut rows.roll_deg {
            *roll = (*roll / step_deg).round() * step_deg;
        }
    }
}

/// Clipping below the largest roll of the campaign, by 20 % of it in the middle.
pub(super) const CLIPPING: Row = Row {
    id: "instrument.clipping",
    symbols: &["share [-]"],
    draw: |size, _, _| vec![size * 0.2],
    hide: |values| Box::new(Clipping { share: values[0], largest: 0.0 }),
};

struct Clipping {
    share: f64,
    largest: f64,
}

impl Hidden for Clipping {
    fn plan(&mut self, passes: &mut [Pass]) {
        let swing = |pass: &Pass| match pass.action {
            Action::Decay { heel_rad } => heel_rad.abs(),
            Action::Forced { amplitude_rad, .. } => amplitude_rad,
        };
        self.largest = passes.iter().map(swing).fold(0.0, f64::max);
    }

    fn spoil(&self, rows: &mut Rows, _pass: &Pass) {
        let limit_deg = (self.largest * (1.0 - self.share)).to_degrees();
        for roll in &mut rows.roll_deg {
            *roll = roll.clamp(-limit_deg, limit_deg);
        }
    }
}
