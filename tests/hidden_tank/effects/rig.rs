//! Carriage, hands and clamps: what the rig adds to the rolling of the model.

use crate::hidden_tank::effect::{Acting, Hidden, Row, Situation};
use crate::hidden_tank::motion::Motion;
use crate::hidden_tank::plan::{Action, Pass};

/// The joints of the rail shake the potentiometer: amplitude with the speed, 0.02 to 0.2 degrees
/// at Fr 0.4, middle 0.063; frequency speed by pitch, 5 to 15 Hz at Fr 0.4.
pub(super) const VIBRATION: Row = Row {
    id: "tank.carriage_vibration",
    symbols: &["amplitude at 2 m/s [rad]", "pitch [m]"],
    draw: |size, draw, _| vec![size * 0.063_f64.to_radians(), 2.0 / draw.between(5.0, 15.0)],
    hide: |values| Box::new(Vibration { amplitude: values[0], pitch_m: values[1] }),
};

struct Vibration {
    amplitude: f64,
    pitch_m: f64,
}

impl Hidden for Vibration {
    fn transduce(&self, motion: &mut Motion, pass: &Pass) {
        let mut way_m = self.pitch_m * pass.chance[5];
        for (roll, speed) in motion.roll.iter_mut().zip(&motion.speed) {
            way_m += speed * motion.step_s;
            let turn = std::f64::consts::TAU * way_m / self.pitch_m;
            *roll += self.amplitude * speed / 2.0 * turn.sin();
        }
    }
}

/// A hand lets go slowly: it still carries a share of the heeling moment, 30 % in the middle,
/// that fades with 0.05 to 0.15 s.
pub(super) const SLOW_RELEASE: Row = Row {
    id: "tank.slow_release",
    symbols: &["share [-]", "fade [s]"],
    draw: |size, draw, _| vec![size * 0.3, draw.between(0.05, 0.15)],
    hide: |values| {
        Acting::hidden(values, |v, at| match at.pass.action {
            Action::Decay { heel_rad } if at.free && at.since_start_s >= 0.0 => {
                let fade = (-at.since_start_s / v[1]).exp();
                v[0] * at.base.restoring * heel_rad * fade
            }
            _ => 0.0,
        })
    },
};

/// A soft clamp lets the model sway: a second mode of 2.5 to 8 Hz, coupled through the inertia;
/// `m12^2/(I m22)` 0.01 to 0.05, middle 0.022.
pub(super) const COUPLED_MODE: Row = Row {
    id: "tank.coupled_mode",
    symbols: &["m12^2/(I m22) [-]", "frequency [rad/s]", "zeta [-]"],
    draw: |size, draw, _| {
        let frequency_hz = draw.between(2.5, 8.0);
        vec![size * 0.022, std::f64::consts::TAU * frequency_hz, draw.between(0.02, 0.05)]
    },
    hide: |values| {
        Box::new(CoupledMode { coupling: values[0], frequency: values[1], ratio: values[2] })
    },
};

/// With `y` scaled by `sqrt(m22/I)` and `s = sqrt(coupling)`:
/// `phi'' + s y'' = moments/I`, `y'' + s phi'' + 2 zeta w y' + w^2 y = 0`.
struct CoupledMode {
    coupling: f64,
    frequency: f64,
    ratio: f64,
}

impl CoupledMode {
    /// Spring and damper of the clamp, by mass.
    fn clamp(&self, own: &[f64]) -> f64 {
        2.0 * self.ratio * self.frequency * own[1] + self.frequency.powi(2) * own[0]
    }
}

impl Hidden for CoupledMode {
    fn n_states(&self) -> usize {
        2
    }

    fn rates(&self, _at: &Situation, acceleration: f64, own: &[f64], out: &mut [f64]) {
        out[0] = own[1];
        out[1] = -self.coupling.sqrt() * acceleration - self.clamp(own);
    }

    fn moment(&self, at: &Situation, own: &[f64]) -> f64 {
        at.base.inertia * self.coupling.sqrt() * self.clamp(own)
    }

    fn inertia(&self, at: &Situation) -> f64 {
        -self.coupling * at.base.inertia
    }
}
