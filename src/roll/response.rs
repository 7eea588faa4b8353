//! How a decay answers a small moment: the linearised equation solved by variation of constants.

use super::equation::{Decay, Expansion, Motion, N_TERMS, Series, at, product_term};

/// Change of a decay [rad, rad/s, rad/s2] per unit of whatever changed it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Of the roll.
    pub roll: f64,
    /// Of the roll rate.
    pub rate: f64,
    /// Of the roll acceleration.
    pub acceleration: f64,
}

/// A decay with the two free solutions of its linearised equation
/// `s'' + (b1 + 2 b2 |phi'| + 3 b3 phi'^2) s' + w^2 (1 + 3 k3 phi^2) s = f`, from which the
/// response to any forcing `f(phi, phi')` is two running integrals.
pub struct Path {
    decay: Decay,
    /// Starts of the intervals of the mesh, its end last.
    nodes: Vec<Instant>,
    /// Middles of the intervals.
    middles: Vec<Instant>,
    widths_s: Vec<f64>,
    /// Position in `nodes` of each time that was asked for.
    asked: Vec<usize>,
}

#[derive(Clone, Copy)]
struct Instant {
    roll: f64,
    rate: f64,
    /// The free solution from a unit of roll, and its rate.
    first: (f64, f64),
    /// The free solution from a unit of rate, and its rate.
    second: (f64, f64),
    /// Both solutions over their Wronskian.
    kernels: (f64, f64),
}

impl Instant {
    fn new(motion: (f64, f64), first: (f64, f64), second: (f64, f64)) -> Self {
        let over_wronskian = (first.0 * second.1 - first.1 * second.0).recip();
        let kernels = (first.0 * over_wronskian, second.0 * over_wronskian);
        Self { roll: motion.0, rate: motion.1, first, second, kernels }
    }
}

impl Path {
    /// Solves `decay` at `time_s` [s], which starts at zero and rises.
    pub fn new(decay: &Decay, time_s: &[f64]) -> Self {
        let start = Instant::new(
            (decay.initial_roll_rad, decay.initial_roll_rate_rad_per_s),
            (1.0, 0.0),
            (0.0, 1.0),
        );
        let mut path = Self {
            decay: *decay,
            nodes: Vec::with_capacity(time_s.len() + 1),
            middles: Vec::with_capacity(time_s.len()),
            widths_s: Vec::with_capacity(time_s.len()),
            asked: Vec::with_capacity(time_s.len()),
        };
        path.nodes.push(start);
        let (mut now, mut now_s) = (start, 0.0);
        for &until_s in time_s {
            decay.advance((now.roll, now.rate), until_s - now_s, |piece| {
                let (motion, step_s) = (&piece.motion, piece.step_s);
                let (first, second) =
                    (free(motion, now.first, step_s), free(motion, now.second, step_s));
                let pair = |series: &(Series, Series), share: f64| {
                    (at(&series.0, share), at(&series.1, share))
                };
                let instant = |share: f64| {
                    let moved = (at(&motion.roll, share), at(&motion.rate, share));
                    Instant::new(moved, pair(&first, share), pair(&second, share))
                };
                path.middles.push(instant(0.5 * piece.share));
                now = instant(piece.share);
                path.nodes.push(now);
                path.widths_s.push(step_s * piece.share);
            });
            now_s = until_s;
            path.asked.push(path.nodes.len() - 1);
        }
        path
    }

    /// The decay itself at the times asked for.
    pub fn motion(&self) -> impl Iterator<Item = Motion> {
        self.asked.iter().map(|&node| self.decay.at(self.nodes[node].roll, self.nodes[node].rate))
    }

    /// Response to a unit of initial roll.
    pub fn to_initial_roll(&self) -> Vec<Response> {
        self.answer(|_| (1.0, 0.0), |_, _| 0.0)
    }

    /// Response to a unit of initial roll rate.
    pub fn to_initial_rate(&self) -> Vec<Response> {
        self.answer(|_| (0.0, 1.0), |_, _| 0.0)
    }

    /// Response to a moment per unit inertia `forcing(phi, phi')` [rad/s2].
    pub fn to_moment(&self, forcing: impl Fn(f64, f64) -> f64) -> Vec<Response> {
        let f = |instant: &Instant| forcing(instant.roll, instant.rate);
        // Simpson's rule: the mesh has twenty intervals a period or more.
        let mut weights = Vec::with_capacity(self.nodes.len());
        let (mut first, mut second) = (0.0, 0.0);
        weights.push((0.0, 0.0));
        let start = &self.nodes[0];
        let mut left = scaled(start.kernels, f(start));
        for ((middle, right), width_s) in
            self.middles.iter().zip(&self.nodes[1..]).zip(&self.widths_s)
        {
            let (inner, end) = (scaled(middle.kernels, f(middle)), scaled(right.kernels, f(right)));
            first -= width_s / 6.0 * (left.1 + 4.0 * inner.1 + end.1);
            second += width_s / 6.0 * (left.0 + 4.0 * inner.0 + end.0);
            weights.push((first, second));
            left = end;
        }
        self.answer(|node| weights[node], forcing)
    }

    fn answer(
        &self,
        weights: impl Fn(usize) -> (f64, f64),
        forcing: impl Fn(f64, f64) -> f64,
    ) -> Vec<Response> {
        let w2 = self.decay.natural_frequency_rad_s.powi(2);
        let Decay { b1_per_s: b1, b2, b3_s: b3, .. } = self.decay;
        let k3 = self.decay.restoring_cubic_per_rad2;
        let response = |&node: &usize| {
            let now = &self.nodes[node];
            let (first, second) = weights(node);
            let roll = first * now.first.0 + second * now.second.0;
            let rate = first * now.first.1 + second * now.second.1;
            let slope = b1 + 2.0 * b2 * now.rate.abs() + 3.0 * b3 * now.rate * now.rate;
            let restoring = w2 * (1.0 + 3.0 * k3 * now.roll * now.roll) * roll;
            Response {
                roll,
                rate,
                acceleration: forcing(now.roll, now.rate) - slope * rate - restoring,
            }
        };
        self.asked.iter().map(response).collect()
    }
}

fn scaled(pair: (f64, f64), factor: f64) -> (f64, f64) {
    (pair.0 * factor, pair.1 * factor)
}

/// The series of a free solution and of its rate over a step [s].
fn free(motion: &Expansion, from: (f64, f64), step_s: f64) -> (Series, Series) {
    let (mut value, mut rate) = ([0.0; N_TERMS], [0.0; N_TERMS]);
    (value[0], rate[0]) = from;
    for n in 0..N_TERMS - 1 {
        let share = step_s / (n + 1) as f64;
        let damping = product_term(&motion.damping_slope, &rate, n);
        let restoring = product_term(&motion.restoring_slope, &value, n);
        value[n + 1] = share * rate[n];
        rate[n + 1] = -share * (damping + restoring);
    }
    (value, rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECAY: Decay = Decay {
        initial_roll_rad: 0.2,
        initial_roll_rate_rad_per_s: 0.1,
        natural_frequency_rad_s: 6.905,
        b1_per_s: 0.38,
        b2: 0.2,
        b3_s: 0.14,
        restoring_cubic_per_rad2: 0.5,
    };

    /// Largest miss of a response against the difference of two neighbouring decays.
    fn miss(response: &[Response], times: &[f64], moved: impl Fn(f64) -> Decay) -> f64 {
        const STEP: f64 = 1e-5;
        let (up, down) = (moved(STEP).motion(times), moved(-STEP).motion(times));
        let largest = |of: &dyn Fn(&Motion) -> f64, answer: &dyn Fn(&Response) -> f64| {
            let differences = up.iter().zip(&down).map(|(u, d)| (of(u) - of(d)) / (2.0 * STEP));
            let (mut worst, mut size) = (0.0_f64, 0.0_f64);
            for (difference, response) in differences.zip(response) {
                worst = worst.max((difference - answer(response)).abs());
                size = size.max(difference.abs());
            }
            worst / size
        };
        largest(&|m| m.roll_rad, &|r| r.roll)
            .max(largest(&|m| m.roll_rate_rad_per_s, &|r| r.rate))
            .max(largest(&|m| m.roll_acceleration_rad_per_s2, &|r| r.acceleration))
    }

    #[test]
    fn the_responses_are_the_differences_of_neighbouring_decays() {
        let times: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.045).collect();
        let path = Path::new(&DECAY, &times);
        let roll = miss(&path.to_initial_roll(), &times, |h| Decay {
            initial_roll_rad: DECAY.initial_roll_rad + h,
            ..DECAY
        });
        let rate = miss(&path.to_initial_rate(), &times, |h| Decay {
            initial_roll_rate_rad_per_s: DECAY.initial_roll_rate_rad_per_s + h,
            ..DECAY
        });
        let linear = miss(&path.to_moment(|_, rate| -rate), &times, |h| Decay {
            b1_per_s: 0.38 + h,
            ..DECAY
        });
        let cubic = miss(&path.to_moment(|_, rate| -rate.powi(3)), &times, |h| Decay {
            b3_s: 0.14 + h,
            ..DECAY
        });
        for worst in [roll, rate, linear, cubic] {
            assert!(worst < 1e-4, "{worst}");
        }
    }

    #[test]
    fn a_hole_in_the_times_does_not_spoil_what_follows() {
        let dense: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.02).collect();
        let holed: Vec<f64> = dense.iter().copied().filter(|t| !(2.0..5.5).contains(t)).collect();
        let last = |times: &[f64]| {
            *Path::new(&DECAY, times).to_moment(|phi, _| -phi).last().expect("times are asked for")
        };
        let (whole, part) = (last(&dense), last(&holed));
        assert!((whole.roll - part.roll).abs() < 1e-4 * whole.roll.abs(), "{whole:?} {part:?}");
    }
}
