//! The equation of free rolling per unit inertia, solved by its Taylor series.

/// A free decay of `phi'' + b1 phi' + b2 phi'|phi'| + b3 phi'^3 + w^2 (phi + k3 phi^3) = 0`: (4.1)
/// with the law of Sec. 4.1, the field's quadratic term, and a cubic part of the righting arm.
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
    /// Quadratic damping `b2` [-].
    pub b2: f64,
    /// Cubic damping `b3` [s].
    pub b3_s: f64,
    /// Cubic part of the restoring moment `k3 = K3/K` [1/rad2].
    pub restoring_cubic_per_rad2: f64,
}

/// Roll with its derivatives at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Roll [rad].
    pub roll_rad: f64,
    /// Roll rate [rad/s].
    pub roll_rate_rad_per_s: f64,
    /// Roll acceleration [rad/s2].
    pub roll_acceleration_rad_per_s2: f64,
}

/// Longest step in scaled time: the first term left out of a series of this order is 3e-9 of the
/// roll, so the frequency is right to a hundred-millionth.
const LONGEST_STEP: f64 = 0.32;

/// Terms of a series over one step, the constant first.
pub(super) const N_TERMS: usize = 8;

/// A power series over one step, its argument running from 0 to 1.
pub(super) type Series = [f64; N_TERMS];

/// The series of a motion and of what the linearised equation needs of it.
pub(super) struct Expansion {
    /// Roll [rad].
    pub(super) roll: Series,
    /// Roll rate [rad/s].
    pub(super) rate: Series,
    /// Slope of the damping by the rate, `b1 + 2 b2 |phi'| + 3 b3 phi'^2` [1/s].
    pub(super) damping_slope: Series,
    /// Slope of the restoring by the roll, `w^2 (1 + 3 k3 phi^2)` [1/s2].
    pub(super) restoring_slope: Series,
}

/// One stretch of a motion.
pub(super) struct Piece {
    /// Length of the series [s].
    pub(super) step_s: f64,
    /// Share of it that the piece covers [-].
    pub(super) share: f64,
    /// The series.
    pub(super) motion: Expansion,
}

impl Piece {
    /// Roll [rad] and rate [rad/s] at its end.
    fn end(&self) -> (f64, f64) {
        (at(&self.motion.roll, self.share), at(&self.motion.rate, self.share))
    }
}

/// The share of a step at which a rate changes its sign; none where it keeps it.
fn turn(rate: &Series) -> Option<f64> {
    // A rate that starts from nil has the sign of its slope.
    let sign = if rate[0] == 0.0 { rate[1] } else { rate[0] };
    if at(rate, 1.0) * sign >= 0.0 {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if at(rate, middle) * sign > 0.0 { low = middle } else { high = middle }
    }
    (high > 0.0).then_some(high)
}

/// The value of a series at `share` of its step.
pub(super) fn at(series: &Series, share: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, term| sum * share + term)
}

/// Term `n` of the product of two series.
#[inline]
pub(super) fn product_term(a: &Series, b: &Series, n: usize) -> f64 {
    let mut sum = 0.0;
    for k in 0..=n {
        sum += a[k] * b[n - k];
    }
    sum
}

/// Term `n` of the square of a series.
#[inline]
fn square_term(a: &Series, n: usize) -> f64 {
    let mut sum = 0.0;
    for k in 0..n.div_ceil(2) {
        sum += a[k] * a[n - k];
    }
    sum *= 2.0;
    if n.is_multiple_of(2) { sum + a[n / 2] * a[n / 2] } else { sum }
}

impl Decay {
    /// The motion at `time_s` [s], which rises and may start before zero.
    pub fn motion(&self, time_s: &[f64]) -> Vec<Motion> {
        let mut out = Vec::with_capacity(time_s.len());
        let Some((&first_s, &last_s)) = time_s.first().zip(time_s.last()) else { return out };
        let mut state = (self.initial_roll_rad, self.initial_roll_rate_rad_per_s);
        self.advance(state, first_s, |piece| state = piece.end());
        // One series serves every time up to the end of its piece.
        let mut asked = time_s.iter().peekable();
        let mut start_s = first_s;
        self.advance(state, last_s - first_s, |piece| {
            let end_s = start_s + piece.step_s * piece.share;
            while let Some(asked_s) = asked.next_if(|t| **t <= end_s) {
                let share = (asked_s - start_s) / piece.step_s;
                out.push(self.at(at(&piece.motion.roll, share), at(&piece.motion.rate, share)));
            }
            (start_s, state) = (end_s, piece.end());
        });
        // Rounding may leave the last one just beyond the end.
        out.extend(asked.map(|_| self.at(state.0, state.1)));
        out
    }

    /// Follows the motion over a span [s] from a roll [rad] and a rate [rad/s], piece by piece.
    ///
    /// A quadratic law bends where the rate changes its sign, so a piece ends there.
    pub(super) fn advance(&self, from: (f64, f64), span_s: f64, mut each: impl FnMut(&Piece)) {
        let (n_steps, step_s) = self.steps(span_s);
        let mut state = from;
        for _ in 0..n_steps {
            let mut left = 1.0;
            // Two changes of sign in one step are rounding about a turning point.
            for n_turns in 0..3 {
                let width_s = left * step_s;
                let motion = self.expansion(state, width_s);
                let turning =
                    if self.b2 == 0.0 || n_turns == 2 { None } else { turn(&motion.rate) };
                let piece = Piece { step_s: width_s, share: turning.unwrap_or(1.0), motion };
                each(&piece);
                state = piece.end();
                let Some(share) = turning else { break };
                state.1 = 0.0;
                left *= 1.0 - share;
            }
        }
    }

    /// How many steps of which length [s] lead over a span [s].
    fn steps(&self, span_s: f64) -> (usize, f64) {
        /// A frequency so wrong that it would ask for more is a fit gone astray.
        const MOST: f64 = 1e6;
        let wanted = (span_s * self.natural_frequency_rad_s / LONGEST_STEP).abs().ceil();
        let n_steps = wanted.clamp(1.0, MOST);
        if span_s == 0.0 { (0, 0.0) } else { (n_steps as usize, span_s / n_steps) }
    }

    /// The motion at a roll [rad] and a rate [rad/s].
    pub(super) fn at(&self, roll_rad: f64, rate: f64) -> Motion {
        let arm = roll_rad * (1.0 + self.restoring_cubic_per_rad2 * roll_rad * roll_rad);
        let damping = rate * (self.b1_per_s + self.b2 * rate.abs() + self.b3_s * rate * rate);
        Motion {
            roll_rad,
            roll_rate_rad_per_s: rate,
            roll_acceleration_rad_per_s2: -damping - self.natural_frequency_rad_s.powi(2) * arm,
        }
    }

    /// The series of the motion over a step [s] from a roll [rad] and a rate [rad/s].
    fn expansion(&self, from: (f64, f64), step_s: f64) -> Expansion {
        let (mut roll, mut rate) = ([0.0; N_TERMS], [0.0; N_TERMS]);
        let (mut rate_squared, mut roll_squared) = (roll, roll);
        (roll[0], rate[0]) = from;
        let w2 = self.natural_frequency_rad_s.powi(2);
        let (b1, b3, k3) = (self.b1_per_s, self.b3_s, self.restoring_cubic_per_rad2);
        // From a turning point the rate takes the sign that the restoring gives it.
        let side = if from.1 == 0.0 { -from.0 * step_s } else { from.1 };
        let b2 = self.b2 * side.signum();
        for n in 0..N_TERMS {
            rate_squared[n] = square_term(&rate, n);
            roll_squared[n] = square_term(&roll, n);
            if n + 1 == N_TERMS {
                break;
            }
            let damping =
                b1 * rate[n] + b2 * rate_squared[n] + b3 * product_term(&rate_squared, &rate, n);
            let arm = roll[n] + k3 * product_term(&roll_squared, &roll, n);
            let share = step_s / (n + 1) as f64;
            roll[n + 1] = share * rate[n];
            rate[n + 1] = -share * (damping + w2 * arm);
        }
        let mut damping_slope = rate_squared.map(|term| 3.0 * b3 * term);
        for (slope, term) in damping_slope.iter_mut().zip(rate) {
            *slope += 2.0 * b2 * term;
        }
        damping_slope[0] += b1;
        let mut restoring_slope = roll_squared.map(|term| 3.0 * k3 * w2 * term);
        restoring_slope[0] += w2;
        Expansion { roll, rate, damping_slope, restoring_slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_undamped_linear_decay_is_a_cosine() {
        let decay = Decay {
            initial_roll_rad: 0.2,
            initial_roll_rate_rad_per_s: 0.1,
            natural_frequency_rad_s: 6.905,
            b1_per_s: 0.0,
            b2: 0.0,
            b3_s: 0.0,
            restoring_cubic_per_rad2: 0.0,
        };
        let times: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.045).collect();
        for (t, motion) in times.iter().zip(decay.motion(&times)) {
            let (sin, cos) = (6.905 * t).sin_cos();
            let exact = 0.2 * cos + 0.1 / 6.905 * sin;
            assert!((motion.roll_rad - exact).abs() < 5e-7, "{t}: {} {exact}", motion.roll_rad);
        }
    }

    #[test]
    fn the_energy_lost_is_the_work_of_the_damping() {
        let decay = Decay {
            initial_roll_rad: 0.4,
            initial_roll_rate_rad_per_s: 0.0,
            natural_frequency_rad_s: 2.5,
            b1_per_s: 0.2,
            b2: 0.3,
            b3_s: 0.5,
            restoring_cubic_per_rad2: 0.7,
        };
        let times: Vec<f64> = (0..=4000).map(|i| f64::from(i) * 0.005).collect();
        let motion = decay.motion(&times);
        let energy = |m: &Motion| {
            let arm = 0.5 * m.roll_rad.powi(2) + 0.25 * 0.7 * m.roll_rad.powi(4);
            0.5 * m.roll_rate_rad_per_s.powi(2) + 6.25 * arm
        };
        let power = |m: &Motion| {
            let rate = m.roll_rate_rad_per_s.abs();
            0.2 * rate.powi(2) + 0.3 * rate.powi(3) + 0.5 * rate.powi(4)
        };
        // Simpson's rule.
        let work: f64 = motion
            .windows(3)
            .step_by(2)
            .map(|m| 0.005 / 3.0 * (power(&m[0]) + 4.0 * power(&m[1]) + power(&m[2])))
            .sum();
        let lost = energy(&motion[0]) - energy(&motion[4000]);
        // The series leaves out 1e-9 of each step, and this is a hundred and fifty of them.
        assert!((lost / work - 1.0).abs() < 3e-6, "{lost} {work}");
    }
}
