//! Waves in the tank: the model's own from the walls, and those left from the run before.

use std::f64::consts::PI;

use crate::hidden_tank::base::{Base, GRAVITY_M_S2, froude};
use crate::hidden_tank::effect::{Acting, Hidden, Row};
use crate::hidden_tank::plan::Pass;

/// Way of a wave to the side wall and back [m]: tank of 10 m, model of 0.387 m.
const WAY_M: f64 = 9.61;
/// Froude number from which own waves stay behind the model.
const OUTRUN: f64 = 0.088;

/// The model's own waves come back: `-R B0` times the roll rate through the dispersion of deep
/// water, `exp(-i w^2 D/g)`; R 0.2 to 0.8, middle 0.4. A moving model outruns them.
pub(super) const REFLECTION: Row = Row {
    id: "tank.wall_reflection",
    symbols: &["R [-]"],
    draw: |size, _, _| vec![size * 0.4],
    hide: |values| Box::new(Reflection(values[0])),
};

struct Reflection(f64);

/// The kernel is wanted at this spacing at least [s]; it turns at 15 rad/s after 30 s.
const KERNEL_S: f64 = 0.02;

impl Hidden for Reflection {
    fn echo(&self, base: &Base, pass: &Pass, past: &[f64], step_s: f64) -> f64 {
        let behind = 1.0 - froude(pass.speed_m_s) / OUTRUN;
        if behind <= 0.0 {
            return 0.0;
        }
        let stride = (KERNEL_S / step_s).round().max(1.0) as usize;
        let spacing_s = stride as f64 * step_s;
        let natural = base.natural_rad_s();
        let mut sum = 0.0;
        for (back, rate) in past.iter().rev().step_by(stride).enumerate() {
            let delay_s = back as f64 * spacing_s;
            // Inverse transform of exp(-i w|w| D/g); the wave that arrives now has this frequency.
            let arriving = GRAVITY_M_S2 * delay_s / (2.0 * WAY_M);
            let kernel = (GRAVITY_M_S2 / (PI * WAY_M)).sqrt()
                * (GRAVITY_M_S2 * delay_s.powi(2) / (4.0 * WAY_M) - PI / 4.0).cos();
            // A slow motion makes hardly any waves.
            let radiated = (arriving / natural).powi(2).min(1.5);
            sum += kernel * radiated * rate * spacing_s;
        }
        -self.0 * behind * base.b0 * sum
    }
}

/// Waves of the run before at one of the tank's cross modes, `a cos(w t + e) exp(-t/60 s)`, phase
/// and mode by pass; 0.003 to 0.05 N m, middle 0.012.
pub(super) const RESIDUAL_WAVE: Row = Row {
    id: "tank.residual_wave",
    symbols: &["a [N m]"],
    draw: |size, _, _| vec![size * 0.012],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let modes = [5.82, 6.33, 6.80, 7.24];
            let mode = modes[(at.pass.chance[2] * modes.len() as f64) as usize];
            let phase = 2.0 * PI * at.pass.chance[3];
            // The crew does not wait equally long before every pass.
            let waited = 0.6 + 0.8 * at.pass.chance[4];
            v[0] * waited * (-at.time_s.max(0.0) / 60.0).exp() * (mode * at.time_s + phase).cos()
        })
    },
};
