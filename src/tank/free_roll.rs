//! Free rolling as the simulated tank would show it to ideal instruments.

use super::equation::{RollState, RollingModel, advance};
use super::motion::STEP_S;

/// A freely rolling model, everything per unit inertia.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeRoll {
    /// Natural frequency at small angles [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Linear damping [1/s].
    pub b1_per_s: f64,
    /// Cubic damping [s].
    pub b3_s: f64,
    /// Roll at the start [rad].
    pub initial_roll_rad: f64,
    /// Roll rate at the start [rad/s].
    pub initial_roll_rate_rad_per_s: f64,
}

impl FreeRoll {
    /// Roll [rad] and roll rate [rad/s] every `interval_s`, from the start on.
    pub fn motion(&self, interval_s: f64, n_samples: usize) -> Vec<(f64, f64)> {
        let model = RollingModel {
            inertia_kg_m2: 1.0,
            restoring_n_m_per_rad: self.natural_frequency_rad_s.powi(2),
            b3_s: self.b3_s,
            rest_roll_rad: 0.0,
        };
        let n_steps = (interval_s / STEP_S).ceil().max(1.0) as usize;
        let step_s = interval_s / n_steps as f64;
        let mut state = RollState {
            roll_rad: self.initial_roll_rad,
            rate_rad_per_s: self.initial_roll_rate_rad_per_s,
        };
        let mut motion = Vec::with_capacity(n_samples);
        for _ in 0..n_samples {
            motion.push((state.roll_rad, state.rate_rad_per_s));
            for _ in 0..n_steps {
                // The equation does not name the time, so every step may start at zero.
                state =
                    advance(state, 0.0, step_s, |_, s| model.acceleration(self.b1_per_s, s, 0.0));
            }
        }
        motion
    }
}
