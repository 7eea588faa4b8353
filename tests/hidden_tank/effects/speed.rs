//! What grows, fades or wavers with the speed of the carriage.

use crate::hidden_tank::base::{DRAFT_M, GRAVITY_M_S2, speed_m_s};
use crate::hidden_tank::effect::{Acting, Hidden, Row, Situation};
use crate::hidden_tank::plan::Pass;

/// Fastest Froude number of the tank, at which sizes are given.
const FASTEST: f64 = 0.4;

/// Friction of the loaded bearing, `Mf (Fr/0.4)^2`; 0.01 to 0.06 N m, middle 0.0245.
pub(super) const FRICTION: Row = Row {
    id: "damping.friction_speed",
    symbols: &["Mf at Fr 0.4 [N m]", "v [rad/s]"],
    draw: |size, draw, _| vec![size * 0.0245, draw.between(0.005, 0.05)],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            -v[0] * (at.froude / FASTEST).powi(2) * (at.rate / v[1]).tanh()
        })
    },
};

/// Lift, linear in the speed: `BL (Fr/0.4) phi'`; `BL/I` 0.03 to 0.16 1/s, middle 0.07.
pub(super) const LIFT: Row = Row {
    id: "damping.lift",
    symbols: &["BL at Fr 0.4 [N m s]"],
    draw: |size, _, base| vec![size * 0.07 * base.inertia],
    hide: |values| Acting::hidden(values, |v, at| -v[0] * at.froude / FASTEST * at.rate),
};

/// The cubic part with speed: grows as `1 + c Fr^2`, c 4 in the middle, or fades as eddies do,
/// `x^2/(1 + x^2)` with `x = 0.139/(s Fr)` (Ikeda's eddy factor at the natural frequency).
pub(super) const NONLINEAR: Row = Row {
    id: "damping.nonlinear_speed",
    symbols: &["c [-]", "fading [-]"],
    draw: |size, draw, _| {
        if draw.sign() > 0.0 { vec![size * 4.0, 0.0] } else { vec![size, 1.0] }
    },
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let factor = if v[1] == 0.0 {
                1.0 + v[0] * at.froude.powi(2)
            } else {
                1.0 / (1.0 + (v[0] * at.froude / 0.139).powi(2))
            };
            let [_, scatter] = at.pass.scatter;
            -(factor - 1.0) * scatter * at.base.b3 * at.rate.powi(3)
        })
    },
};

/// Wave damping with speed: the hump near `w V/g = 1/4` and the level beyond, in the form of
/// ITTC 7.5-02-07-04.5, times a strength of 1 in the middle.
pub(super) const WAVE: Row = Row {
    id: "damping.wave_speed",
    symbols: &["strength [-]"],
    draw: |size, _, _| vec![size],
    hide: |values| {
        Acting::hidden(values, |v, at| {
            let w = at.base.natural_rad_s();
            let tau = w * speed_m_s(at.froude) / GRAVITY_M_S2;
            let growth = wave_factor(w, tau) / wave_factor(w, 0.0) - 1.0;
            -v[0] * growth * at.base.b0 * at.rate
        })
    },
};

/// Wave damping by that at rest; both levels and the hump depend on the depth in wave lengths.
fn wave_factor(w: f64, tau: f64) -> f64 {
    let depth = w * w * DRAFT_M / GRAVITY_M_S2;
    let falls = (-2.0 * depth).exp();
    let a1 = 1.0 + depth.powf(-1.2) * falls;
    let a2 = 0.5 + falls / depth;
    let level = (a2 + 1.0) + (a2 - 1.0) * (20.0 * (tau - 0.3)).tanh();
    0.5 * (level + (2.0 * a1 - a2 - 1.0) * (-150.0 * (tau - 0.25).powi(2)).exp())
}

/// Restoring with speed, `K (1 + c Fr^2)`; c within 0.3 either way, middle 0.15.
pub(super) const RESTORING: Row = Row {
    id: "restoring.speed",
    symbols: &["c [-]"],
    draw: |size, draw, _| vec![size * 0.15 * draw.sign()],
    hide: |values| {
        Acting::hidden(values, |v, at| -at.base.restoring * v[0] * at.froude.powi(2) * at.roll)
    },
};

/// Added inertia with speed, `I (1 + c Fr^2)`; within 5 % at Fr 0.4, so c 0.156 in the middle.
pub(super) const INERTIA: Row = Row {
    id: "inertia.speed",
    symbols: &["c [-]"],
    draw: |size, draw, _| vec![size * 0.156 * draw.sign()],
    hide: |values| Box::new(SpeedInertia(values[0])),
};

struct SpeedInertia(f64);

impl Hidden for SpeedInertia {
    fn inertia(&self, at: &Situation) -> f64 {
        at.base.inertia * self.0 * at.froude.powi(2)
    }
}

/// A speed that has not settled, `1 - x exp(-t/2 s)` with x 10 % in the middle, or a wobble of
/// 3 % at 0.2 to 0.5 Hz.
pub(super) const UNSTEADY: Row = Row {
    id: "tank.unsteady_speed",
    symbols: &["share [-]", "frequency [Hz]"],
    draw: |size, draw, _| {
        if draw.sign() > 0.0 {
            vec![size * 0.1, 0.0]
        } else {
            vec![size * 0.03, draw.between(0.2, 0.5)]
        }
    },
    hide: |values| Box::new(Unsteady { share: values[0], frequency_hz: values[1] }),
};

struct Unsteady {
    share: f64,
    frequency_hz: f64,
}

impl Hidden for Unsteady {
    fn speed(&self, pass: &Pass, since_start_s: f64, speed_m_s: f64) -> f64 {
        let error = if self.frequency_hz == 0.0 {
            // Before the release the carriage is as slow as at it.
            -(-since_start_s.max(0.0) / 2.0).exp()
        } else {
            let turns = self.frequency_hz * since_start_s + pass.chance[0];
            (std::f64::consts::TAU * turns).sin()
        };
        speed_m_s * (1.0 + self.share * error)
    }
}
