//! The roll that a measured moment of any course makes, with its sensitivities.

use super::moment::Moment;

/// Unknowns of a driven run: initial roll, initial rate, inertia, linear and cubic damping.
pub(super) const N_DRIVEN: usize = 5;
/// Position of the inertia among them.
pub(super) const INERTIA: usize = 2;
/// Position of the linear damping.
pub(super) const B1: usize = 3;
/// Position of the cubic damping.
pub(super) const B3: usize = 4;

/// A model under a moment: `phi'' + b1 phi' + b3 phi'^3 = (M - K phi)/I`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Driven {
    /// The unknowns: [rad, rad/s, kg m2, 1/s, s].
    pub(super) values: [f64; N_DRIVEN],
    /// Restoring coefficient `K` [N m/rad].
    pub(super) restoring_n_m_per_rad: f64,
}

/// Roll and rate at one instant with their derivatives by each unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sensitive {
    pub(super) roll_rad: f64,
    pub(super) rate_rad_per_s: f64,
    pub(super) acceleration_rad_per_s2: f64,
    pub(super) roll_by: [f64; N_DRIVEN],
    pub(super) rate_by: [f64; N_DRIVEN],
}

type State = [f64; 2 + 2 * N_DRIVEN];

/// Longest Runge-Kutta step in scaled time: its phase errs by less than 1e-6 per radian.
const LONGEST_STEP: f64 = 0.1;

impl Driven {
    /// Natural frequency [rad/s].
    pub(super) fn natural_rad_s(&self) -> f64 {
        (self.restoring_n_m_per_rad / self.values[INERTIA]).sqrt()
    }

    /// The motion under `moment` at `time_s` [s], which starts at zero and rises.
    pub(super) fn motion(&self, moment: &Moment, time_s: &[f64]) -> Vec<Sensitive> {
        let mut state: State = [0.0; 2 + 2 * N_DRIVEN];
        (state[0], state[1]) = (self.values[0], self.values[1]);
        (state[2], state[2 + N_DRIVEN + 1]) = (1.0, 1.0);
        let w = self.natural_rad_s();
        let mut now_s = 0.0;
        let mut out = Vec::with_capacity(time_s.len());
        for &until_s in time_s {
            let n_steps = ((until_s - now_s) * w / LONGEST_STEP).ceil().clamp(1.0, 1e5);
            let step_s = (until_s - now_s) / n_steps;
            for i in 0..n_steps as usize {
                let start_s = now_s + step_s * i as f64;
                state = self.advance(moment, start_s, step_s, &state);
            }
            now_s = until_s;
            out.push(Sensitive {
                roll_rad: state[0],
                rate_rad_per_s: state[1],
                acceleration_rad_per_s2: self.slope(moment.at_n_m(until_s), &state)[1],
                roll_by: std::array::from_fn(|p| state[2 + p]),
                rate_by: std::array::from_fn(|p| state[2 + N_DRIVEN + p]),
            });
        }
        out
    }

    fn advance(&self, moment: &Moment, time_s: f64, step_s: f64, state: &State) -> State {
        let along = |slope: &State, step: f64| -> State {
            std::array::from_fn(|i| state[i] + step * slope[i])
        };
        let [start, middle, end] =
            [0.0, 0.5, 1.0].map(|share| moment.at_n_m(time_s + share * step_s));
        let first = self.slope(start, state);
        let second = self.slope(middle, &along(&first, 0.5 * step_s));
        let third = self.slope(middle, &along(&second, 0.5 * step_s));
        let fourth = self.slope(end, &along(&third, step_s));
        std::array::from_fn(|i| {
            state[i] + step_s / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        })
    }

    fn slope(&self, moment_n_m: f64, state: &State) -> State {
        let [.., inertia, b1, b3] = self.values;
        let (roll, rate) = (state[0], state[1]);
        let stiffness = self.restoring_n_m_per_rad / inertia;
        let excess = moment_n_m / inertia - stiffness * roll;
        let by_rate = b1 + 3.0 * b3 * rate * rate;
        let direct = [0.0, 0.0, -excess / inertia, -rate, -rate.powi(3)];
        let mut slope = [0.0; 2 + 2 * N_DRIVEN];
        slope[0] = rate;
        slope[1] = excess - b1 * rate - b3 * rate.powi(3);
        for p in 0..N_DRIVEN {
            let (roll_by, rate_by) = (state[2 + p], state[2 + N_DRIVEN + p]);
            slope[2 + p] = rate_by;
            slope[2 + N_DRIVEN + p] = direct[p] - stiffness * roll_by - by_rate * rate_by;
        }
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment() -> Moment {
        let time_s: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
        let values = time_s.iter().map(|t| 3.0 * (3.0 * t + 0.1 * t * t).sin()).collect();
        Moment::new(time_s, values)
    }

    #[test]
    fn the_sensitivities_are_the_differences_of_neighbouring_runs() {
        let values = [0.05, -0.1, 1.7, 0.4, 0.15];
        let driven = Driven { values, restoring_n_m_per_rad: 60.0 };
        let times: Vec<f64> = (0..300).map(|i| f64::from(i) * 0.05).collect();
        let here = driven.motion(&moment(), &times);
        for p in 0..N_DRIVEN {
            let moved = |sign: f64| {
                let mut values = values;
                values[p] += sign * 1e-5;
                Driven { values, ..driven }.motion(&moment(), &times)
            };
            for ((up, down), s) in moved(1.0).iter().zip(&moved(-1.0)).zip(&here) {
                let difference = (up.roll_rad - down.roll_rad) / 2e-5;
                assert!((difference - s.roll_by[p]).abs() < 1e-6, "{p}: {difference}");
                let difference = (up.rate_rad_per_s - down.rate_rad_per_s) / 2e-5;
                assert!((difference - s.rate_by[p]).abs() < 1e-5, "{p}: {difference}");
            }
        }
    }
}
