//! Restoring and inertia other than `K phi` and `I phi''`.

use crate::hidden_tank::base::{Base, GRAVITY_M_S2};
use crate::hidden_tank::effect::{Acting, Hidden, Row, Situation};

/// `K k3 phi^3`; k3 -1 to 1.5, middle 0.5 either way.
pub(super) const CUBIC: Row = Row {
    id: "restoring.cubic",
    symbols: &["K3/K [1/rad2]"],
    draw: |size, draw, _| vec![size * 0.5 * draw.sign()],
    hide: |values| Acting::hidden(values, |v, at| -at.base.restoring * v[0] * at.roll.powi(3)),
};

/// `K k5 phi^5`; k5 0.2 to 5, middle 1.
pub(super) const QUINTIC: Row = Row {
    id: "restoring.quintic",
    symbols: &["K5/K [1/rad4]"],
    draw: |size, _, _| vec![size],
    hide: |values| Acting::hidden(values, |v, at| -at.base.restoring * v[0] * at.roll.powi(5)),
};

/// `K k2 phi^2`; k2 within 0.2 either way, middle 0.1.
pub(super) const ASYMMETRIC: Row = Row {
    id: "restoring.asymmetric",
    symbols: &["K2/K [1/rad]"],
    draw: |size, draw, _| vec![size * 0.1 * draw.sign()],
    hide: |values| Acting::hidden(values, |v, at| -at.base.restoring * v[0] * at.roll.powi(2)),
};

/// Static heel, `K (phi - heel)`; 0.1 to 1 degree, middle 0.32.
pub(super) const HEEL: Row = Row {
    id: "restoring.heel",
    symbols: &["heel [rad]"],
    draw: |size, draw, _| vec![size * 0.32_f64.to_radians() * draw.sign()],
    hide: |values| Acting::hidden(values, |v, at| at.base.restoring * v[0]),
};

/// A loose cable's spring; 0.2 to 3 N m/rad, middle 0.77.
pub(super) const CABLE: Row = Row {
    id: "restoring.cable",
    symbols: &["kc [N m/rad]"],
    draw: |size, _, _| vec![size * 0.77],
    hide: |values| Acting::hidden(values, |v, at| -v[0] * at.roll),
};

/// A GM other than the one of the campaign file, so that the natural frequency that follows from
/// it is wrong by 0.5 to 10 %, middle 2.2 %.
pub(super) const NATURAL_FREQUENCY: Row = Row {
    id: "restoring.natural_frequency",
    symbols: &["share [-]"],
    draw: |size, draw, _| vec![size * 0.022 * draw.sign()],
    hide: |values| {
        Acting::hidden(values, |v, at| -at.base.restoring * ((1.0 + v[0]).powi(2) - 1.0) * at.roll)
    },
};

/// Inertia with amplitude, `I (1 + a phi^2) phi''`; a within 1 either way, middle 0.5.
pub(super) const INERTIA_AMPLITUDE: Row = Row {
    id: "inertia.amplitude",
    symbols: &["a [1/rad2]"],
    draw: |size, draw, _| vec![size * 0.5 * draw.sign()],
    hide: |values| Box::new(AmplitudeInertia(values[0])),
};

struct AmplitudeInertia(f64);

impl Hidden for AmplitudeInertia {
    fn inertia(&self, at: &Situation) -> f64 {
        at.base.inertia * self.0 * at.roll.powi(2)
    }
}

/// Water in a bilge of breadth b: `psi'' + 2 zeta wt psi' + wt^2 (psi + phi) = 0`, moment
/// `-Kt psi`; `Kt = rho g l b^3/12` 3.8 N m/rad in the middle, `wt` 3 to 6 rad/s.
pub(super) const FREE_SURFACE: Row = Row {
    id: "restoring.free_surface",
    symbols: &["Kt [N m/rad]", "wt [rad/s]", "zeta [-]"],
    draw: |size, draw, base: &Base| {
        // Free water of 0.3 m by 0.25 m is a twentieth of the restoring of this hull.
        let middle = 1000.0 * GRAVITY_M_S2 * 0.3 * 0.25_f64.powi(3) / 12.0;
        let share = base.restoring / 79.85;
        vec![size * middle * share, draw.between(3.0, 6.0), draw.between(0.03, 0.1)]
    },
    hide: |values| {
        Box::new(FreeSurface { coefficient: values[0], frequency: values[1], ratio: values[2] })
    },
};

struct FreeSurface {
    coefficient: f64,
    frequency: f64,
    ratio: f64,
}

impl Hidden for FreeSurface {
    fn n_states(&self) -> usize {
        2
    }

    fn rates(&self, at: &Situation, _acceleration: f64, own: &[f64], out: &mut [f64]) {
        let w = self.frequency;
        out[0] = own[1];
        out[1] = -2.0 * self.ratio * w * own[1] - w * w * (own[0] + at.roll);
    }

    fn moment(&self, _at: &Situation, own: &[f64]) -> f64 {
        -self.coefficient * own[0]
    }
}
