//! The simulated model's equation of motion, with an integrator of its own.
//!
//! `(I + dI) phi'' + B1 phi' + B3 phi'^3 + K (phi - phi_rest) = M` (2.1). The identifier has its
//! own statement of it and its own integrator; the two must never share code. The integrator is the
//! two-stage Gauss-Legendre method of order 4 (Hairer, Norsett, Wanner, Solving Ordinary
//! Differential Equations I, Table II.7.3), implicit where the identifier's is explicit.

/// The model as a rigid body that only rolls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RollingModel {
    /// Total inertia `I + dI` [kg m2].
    pub(super) inertia_kg_m2: f64,
    /// Restoring coefficient `K` [N m/rad].
    pub(super) restoring_n_m_per_rad: f64,
    /// Cubic damping per unit inertia [s].
    pub(super) b3_s: f64,
    /// Roll at rest [rad].
    pub(super) rest_roll_rad: f64,
}

/// Roll and roll rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RollState {
    /// Roll [rad].
    pub(super) roll_rad: f64,
    /// Roll rate [rad/s].
    pub(super) rate_rad_per_s: f64,
}

impl RollingModel {
    /// Damping moment [N m] at a roll rate, for the linear coefficient of the moment's speed.
    fn damping_n_m(&self, b1_per_s: f64, rate_rad_per_s: f64) -> f64 {
        self.inertia_kg_m2
            * (b1_per_s * rate_rad_per_s + self.b3_s * rate_rad_per_s * rate_rad_per_s.powi(2))
    }

    /// Roll acceleration [rad/s2] under an applied moment [N m].
    pub(super) fn acceleration(&self, b1_per_s: f64, state: RollState, moment_n_m: f64) -> f64 {
        let restoring = self.restoring_n_m_per_rad * (state.roll_rad - self.rest_roll_rad);
        (moment_n_m - self.damping_n_m(b1_per_s, state.rate_rad_per_s) - restoring)
            / self.inertia_kg_m2
    }

    /// Applied moment [N m] that a given motion takes.
    pub(super) fn moment_needed(&self, b1_per_s: f64, state: RollState, acceleration: f64) -> f64 {
        self.inertia_kg_m2 * acceleration
            + self.damping_n_m(b1_per_s, state.rate_rad_per_s)
            + self.restoring_n_m_per_rad * (state.roll_rad - self.rest_roll_rad)
    }
}

/// Advances `state` from `time_s` by `step_s` under `acceleration(time_s, state)`.
pub(super) fn advance(
    state: RollState,
    time_s: f64,
    step_s: f64,
    acceleration: impl Fn(f64, RollState) -> f64,
) -> RollState {
    // Steps are a hundredth of a radian of roll phase, so each iteration gains four digits or more.
    const MAX_ITERATIONS: usize = 20;
    let third = 3.0_f64.sqrt() / 6.0;
    let (early, late) = (0.25 - third, 0.25 + third);
    let stage_time = [time_s + (0.5 - third) * step_s, time_s + (0.5 + third) * step_s];
    let start = acceleration(time_s, state);
    let mut slope = [(state.rate_rad_per_s, start); 2];
    for _ in 0..MAX_ITERATIONS {
        let at = |a: f64, b: f64| RollState {
            roll_rad: state.roll_rad + step_s * (a * slope[0].0 + b * slope[1].0),
            rate_rad_per_s: state.rate_rad_per_s + step_s * (a * slope[0].1 + b * slope[1].1),
        };
        let stages = [at(0.25, early), at(late, 0.25)];
        let next =
            [0, 1].map(|i| (stages[i].rate_rad_per_s, acceleration(stage_time[i], stages[i])));
        let change = (0..2)
            .map(|i| (next[i].0 - slope[i].0).abs() + (next[i].1 - slope[i].1).abs())
            .fold(0.0, f64::max);
        slope = next;
        if change < 1e-13 {
            break;
        }
    }
    RollState {
        roll_rad: state.roll_rad + 0.5 * step_s * (slope[0].0 + slope[1].0),
        rate_rad_per_s: state.rate_rad_per_s + 0.5 * step_s * (slope[0].1 + slope[1].1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: RollingModel = RollingModel {
        inertia_kg_m2: 1.675,
        restoring_n_m_per_rad: 1.675 * 6.905 * 6.905,
        b3_s: 0.0,
        rest_roll_rad: 0.01,
    };

    fn free(model: RollingModel, b1_per_s: f64, step_s: f64, duration_s: f64) -> RollState {
        let n_steps = (duration_s / step_s).round() as usize;
        let mut state = RollState { roll_rad: 0.21, rate_rad_per_s: 0.0 };
        for k in 0..n_steps {
            state = advance(state, k as f64 * step_s, step_s, |_, s| {
                model.acceleration(b1_per_s, s, 0.0)
            });
        }
        state
    }

    #[test]
    fn linear_decay_follows_its_closed_form() {
        let (b1, w, t) = (0.5_f64, 6.905_f64, 20.0);
        let wd = (w * w - b1 * b1 / 4.0).sqrt();
        let exact = 0.01
            + 0.2 * (-b1 * t / 2.0).exp() * ((wd * t).cos() + b1 / (2.0 * wd) * (wd * t).sin());
        let simulated = free(MODEL, b1, 1e-3, t).roll_rad;
        // Order 4 at h w = 0.007 over 140 rad of phase: 140 (h w)^4 / 720 = 5e-10 of the amplitude.
        assert!((simulated - exact).abs() < 1e-9, "{simulated} against {exact}");
    }

    #[test]
    fn halving_the_step_shrinks_the_error_sixteenfold() {
        let model = RollingModel { b3_s: 0.5, ..MODEL };
        let fine = free(model, 0.4, 1.0 / 1024.0, 4.0).roll_rad;
        let coarse = (free(model, 0.4, 1.0 / 32.0, 4.0).roll_rad - fine).abs();
        let half = (free(model, 0.4, 1.0 / 64.0, 4.0).roll_rad - fine).abs();
        let order = (coarse / half).log2();
        assert!((3.8..4.3).contains(&order), "order {order}, the method's is 4");
    }

    #[test]
    fn undamped_roll_keeps_its_energy() {
        let energy = |s: RollState| {
            0.5 * MODEL.inertia_kg_m2 * s.rate_rad_per_s.powi(2)
                + 0.5 * MODEL.restoring_n_m_per_rad * (s.roll_rad - MODEL.rest_roll_rad).powi(2)
        };
        let start = energy(RollState { roll_rad: 0.21, rate_rad_per_s: 0.0 });
        // Gauss-Legendre methods keep quadratic invariants; only rounding is left.
        assert!((energy(free(MODEL, 0.0, 1e-3, 60.0)) / start - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_moment_needed_gives_the_motion_back() {
        let model = RollingModel { b3_s: 0.7, ..MODEL };
        let state = RollState { roll_rad: -0.1, rate_rad_per_s: 0.8 };
        let moment = model.moment_needed(1.2, state, 3.3);
        assert!((model.acceleration(1.2, state, moment) - 3.3).abs() < 1e-12);
    }
}
