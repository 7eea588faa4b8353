//! Damping that remembers: radiated waves, shed vortices, a flow that has yet to build up.

use crate::hidden_tank::effect::{Acting, Hidden, Row, Situation};

/// Radiation memory (Cummins): the moment is `-x'`, `x'' + a1 x' + a0 x = c phi'`, so that its
/// damping is `c a1 w^2/((a0 - w^2)^2 + (a1 w)^2)`, `c/a1` at most; that by inertia 0.05 to 0.35
/// 1/s, middle 0.132; `sqrt(a0)` 6 to 9 rad/s, `a1` 3 to 8 1/s.
pub(super) const MEMORY: Row = Row {
    id: "damping.memory",
    symbols: &["peak [N m s]", "sqrt a0 [rad/s]", "a1 [1/s]"],
    draw: |size, draw, base| {
        vec![size * 0.132 * base.inertia, draw.between(6.0, 9.0), draw.between(3.0, 8.0)]
    },
    hide: |values| Box::new(Memory { peak: values[0], centre: values[1], width: values[2] }),
};

struct Memory {
    peak: f64,
    centre: f64,
    width: f64,
}

impl Hidden for Memory {
    fn n_states(&self) -> usize {
        2
    }

    fn rates(&self, at: &Situation, _acceleration: f64, own: &[f64], out: &mut [f64]) {
        out[0] = own[1];
        let driven = self.peak * self.width * at.rate;
        out[1] = driven - self.width * own[1] - self.centre.powi(2) * own[0];
    }

    fn moment(&self, _at: &Situation, own: &[f64]) -> f64 {
        -own[1]
    }
}

/// Lagged drag: `B2 z`, `tau z' = phi'|phi'| - z`; `tau` 0.05 to 0.3 s, middle 0.12, of a drag as
/// strong as the base's cubic at 10 degrees.
pub(super) const VORTEX: Row = Row {
    id: "damping.vortex_history",
    symbols: &["B2 [N m s2]", "tau [s]"],
    draw: |size, _, base| {
        let rate = base.natural_rad_s() * 10.0_f64.to_radians();
        vec![9.0 * std::f64::consts::PI / 32.0 * rate * base.b3, size * 0.12]
    },
    hide: |values| Box::new(Vortex { drag: values[0], lag_s: values[1] }),
};

struct Vortex {
    drag: f64,
    lag_s: f64,
}

impl Hidden for Vortex {
    fn n_states(&self) -> usize {
        1
    }

    fn rates(&self, at: &Situation, _acceleration: f64, own: &[f64], out: &mut [f64]) {
        out[0] = (at.rate * at.rate.abs() - own[0]) / self.lag_s;
    }

    fn moment(&self, _at: &Situation, own: &[f64]) -> f64 {
        -self.drag * own[0]
    }
}

/// Flow that builds up: the linear damping lacks `beta exp(-t/T)`; beta 0.2 to 0.5, middle 0.3, T
/// one to two natural periods.
pub(super) const START_UP: Row = Row {
    id: "damping.start_up",
    symbols: &["beta [-]", "T [s]"],
    draw: |size, draw, base| {
        let period_s = std::f64::consts::TAU / base.natural_rad_s();
        vec![size * 0.3, period_s * draw.between(1.0, 2.0)]
    },
    hide: |values| {
        Acting::hidden(values, |v, at| {
            if at.since_start_s < 0.0 {
                return 0.0;
            }
            let [scatter, _] = at.pass.scatter;
            let lacking = v[0] * (-at.since_start_s / v[1]).exp();
            lacking * scatter * at.base.linear(at.froude) * at.rate
        })
    },
};
