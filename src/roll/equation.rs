//! The equation of free rolling per unit inertia, solved with its sensitivities.

/// Number of parameters of a free decay, in the order of [`Decay::parameters`].
pub const N_PARAMETERS: usize = 6;

/// A free decay of `phi'' + b1 phi' + b3 phi'^3 + w^2 (phi + k3 phi^3) = 0`: (4.1) with the law of
/// Sec. 4.1 and a cubic part of the righting arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decay {
    /// Roll at time zero [rad].
    pub initial_roll_rad: f64,
    /// Roll rate at time zero [rad/s].
    pub initial_roll_rate_rad_per_s: f64,
    /// Small-angle natural frequency `w` [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Linear damping `b1` [1/s].
    pub b1_per_s: f64,
    /// Cubic damping `b3` [s].
    pub b3_s: f64,
    /// Cubic part of the restoring moment `k3 = K3/K` [1/rad2].
    pub restoring_cubic_per_rad2: f64,
}

/// Roll and its derivatives by each parameter, at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitive {
    /// Roll [rad].
    pub roll_rad: f64,
    /// Roll rate [rad/s].
    pub roll_rate_rad_per_s: f64,
    /// Derivative of the roll by each parameter, in the order of [`Decay::parameters`].
    pub by_parameter: [f64; N_PARAMETERS],
}

/// Longest step of the fourth-order Runge-Kutta scheme in scaled time. Its phase error per radian,
/// `step^4/120`, stays below 1e-7: a thousand radians of roll shift by less than 1e-4 rad.
const LONGEST_STEP: f64 = 0.05;

type State = [f64; 2 + 2 * N_PARAMETERS];

impl Decay {
    /// The parameters as a list: initial roll, initial rate, `w`, `b1`, `b3`, `k3`.
    pub fn parameters(&self) -> [f64; N_PARAMETERS] {
        [
            self.initial_roll_rad,
            self.initial_roll_rate_rad_per_s,
            self.natural_frequency_rad_s,
            self.b1_per_s,
            self.b3_s,
            self.restoring_cubic_per_rad2,
        ]
    }

    /// The decay with these parameters.
    pub fn from_parameters(values: [f64; N_PARAMETERS]) -> Self {
        let [roll, rate, frequency, b1, b3, k3] = values;
        Self {
            initial_roll_rad: roll,
            initial_roll_rate_rad_per_s: rate,
            natural_frequency_rad_s: frequency,
            b1_per_s: b1,
            b3_s: b3,
            restoring_cubic_per_rad2: k3,
        }
    }

    /// Solves the decay and its variational equations at `time_s` [s], which starts at zero and
    /// rises.
    pub fn solve(&self, time_s: &[f64]) -> Vec<Sensitive> {
        let mut state: State = [0.0; 2 + 2 * N_PARAMETERS];
        state[0] = self.initial_roll_rad;
        state[1] = self.initial_roll_rate_rad_per_s;
        state[2] = 1.0;
        state[2 + N_PARAMETERS + 1] = 1.0;
        let mut now_s = 0.0;
        let mut out = Vec::with_capacity(time_s.len());
        for &until_s in time_s {
            let span_s = until_s - now_s;
            let steps =
                (span_s * self.natural_frequency_rad_s.abs() / LONGEST_STEP).ceil().max(1.0);
            for _ in 0..steps as usize {
                state = self.advance(&state, span_s / steps);
            }
            now_s = until_s;
            out.push(Sensitive {
                roll_rad: state[0],
                roll_rate_rad_per_s: state[1],
                by_parameter: std::array::from_fn(|p| state[2 + p]),
            });
        }
        out
    }

    fn advance(&self, state: &State, step_s: f64) -> State {
        let along = |from: &State, slope: &State, step: f64| -> State {
            std::array::from_fn(|i| from[i] + step * slope[i])
        };
        let first = self.slope(state);
        let second = self.slope(&along(state, &first, 0.5 * step_s));
        let third = self.slope(&along(state, &second, 0.5 * step_s));
        let fourth = self.slope(&along(state, &third, step_s));
        std::array::from_fn(|i| {
            state[i] + step_s / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        })
    }

    fn slope(&self, state: &State) -> State {
        let (phi, rate) = (state[0], state[1]);
        let w = self.natural_frequency_rad_s;
        let (b1, b3, k3) = (self.b1_per_s, self.b3_s, self.restoring_cubic_per_rad2);
        let by_roll = -w * w * (1.0 + 3.0 * k3 * phi * phi);
        let by_rate = -b1 - 3.0 * b3 * rate * rate;
        let arm = phi + k3 * phi.powi(3);
        let mut slope = [0.0; 2 + 2 * N_PARAMETERS];
        slope[0] = rate;
        slope[1] = -b1 * rate - b3 * rate.powi(3) - w * w * arm;
        let forced = [0.0, 0.0, -2.0 * w * arm, -rate, -rate.powi(3), -w * w * phi.powi(3)];
        for p in 0..N_PARAMETERS {
            let (roll_p, rate_p) = (state[2 + p], state[2 + N_PARAMETERS + p]);
            slope[2 + p] = rate_p;
            slope[2 + N_PARAMETERS + p] = by_roll * roll_p + by_rate * rate_p + forced[p];
        }
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECAY: Decay = Decay {
        initial_roll_rad: 0.2,
        initial_roll_rate_rad_per_s: 0.1,
        natural_frequency_rad_s: 6.905,
        b1_per_s: 0.38,
        b3_s: 0.14,
        restoring_cubic_per_rad2: 0.5,
    };

    #[test]
    fn an_undamped_linear_decay_is_a_cosine() {
        let decay = Decay { b1_per_s: 0.0, b3_s: 0.0, restoring_cubic_per_rad2: 0.0, ..DECAY };
        let times: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
        for (t, s) in times.iter().zip(decay.solve(&times)) {
            let exact = 0.2 * (6.905 * t).cos() + 0.1 / 6.905 * (6.905 * t).sin();
            // The scheme's phase error of 138 rad is below 1e-5 rad.
            assert!((s.roll_rad - exact).abs() < 2e-6, "{t}: {} {exact}", s.roll_rad);
        }
    }

    #[test]
    fn the_sensitivities_are_the_differences_of_neighbouring_decays() {
        let times: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.05).collect();
        let here = DECAY.solve(&times);
        for p in 0..N_PARAMETERS {
            let h = 1e-5;
            let moved = |sign: f64| {
                let mut values = DECAY.parameters();
                values[p] += sign * h;
                Decay::from_parameters(values).solve(&times)
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            for ((u, d), s) in up.iter().zip(&down).zip(&here) {
                let difference = (u.roll_rad - d.roll_rad) / (2.0 * h);
                assert!((difference - s.by_parameter[p]).abs() < 1e-6 * (1.0 + difference.abs()));
            }
        }
    }
}
