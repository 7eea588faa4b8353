//! One chain of the sampler of Sec. 2.4.
//!
//! Each site is drawn from its own conditional, in order, exactly as printed. What is not printed
//! is how the conditional is evaluated. It needs `H_j' (g - H U)`, `n` products if summed. But what
//! the sites already drawn in this sweep have changed in `H U` is, after them, a free oscillation:
//! two numbers, turned once per sample, and its product with `H_j` is theirs with two tabulated
//! sums. So a sweep costs `O(n)` and draws the same numbers.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::convolution::Convolution;
use super::log_normal_walk::LogNormalWalk;
use super::settings::{Hyperpriors, PriorPower};

/// The posterior (2.13) to be drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Problem<'a> {
    /// Observable [rad].
    pub(super) g: &'a [f64],
    /// `H`.
    pub(super) convolution: &'a Convolution,
    /// Hyperpriors.
    pub(super) hyper: &'a Hyperpriors,
    /// Power of `lambda` in the prior.
    pub(super) power: PriorPower,
}

/// The state of one chain.
#[derive(Debug, Clone)]
pub(super) struct Gibbs<'a> {
    problem: Problem<'a>,
    overlaps: Overlaps,
    rng: ChaCha8Rng,
    lambda_walk: LogNormalWalk,
    variance_walk: LogNormalWalk,
    /// `g - H U`.
    residual: Vec<f64>,
    /// Moment history `U` [rad/s2].
    pub(super) u: Vec<f64>,
    /// Prior precision `lambda` [s4].
    pub(super) lambda: f64,
    /// Noise `sigma` [rad].
    pub(super) sigma: f64,
}

impl<'a> Gibbs<'a> {
    /// The chain at the paper's start: `lambda = 1`, `sigma = 0.1`, `U = 0`.
    pub(super) fn new(problem: Problem<'a>, seed: u64, chain: u64) -> Self {
        let n = problem.g.len();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(chain);
        // Given U, ln lambda and ln sigma^2 have a standard deviation of sqrt(2/n); 2.4 of these
        // is the best spread for a normal target.
        let spread = 2.4 * (2.0 / n as f64).sqrt();
        Self {
            problem,
            overlaps: Overlaps::new(problem.convolution),
            rng,
            lambda_walk: LogNormalWalk::new(spread),
            variance_walk: LogNormalWalk::new(spread),
            residual: problem.g.to_vec(),
            u: vec![0.0; n],
            lambda: 1.0,
            sigma: 0.1,
        }
    }

    /// One pass over `U`, then `lambda`, then `sigma`.
    pub(super) fn sweep(&mut self, adapt: bool) {
        self.draw_moments();
        self.draw_lambda(adapt);
        self.draw_sigma(adapt);
    }

    /// Draws `U_j` given all the rest, for each `j` in turn.
    ///
    /// By (2.12), `U_j` is normal with precision `H_j'H_j/sigma^2 + lambda n_j`, and its mean lies
    /// `(H_j'(g - HU)/sigma^2 - lambda (WU)_j)/precision` from the present value.
    fn draw_moments(&mut self) {
        let convolution = self.problem.convolution;
        let (turn, dt) = (convolution.turn(), convolution.step_s());
        let last = self.u.len() - 1;
        let weight = 1.0 / (self.sigma * self.sigma);
        let pull = convolution.apply_transposed(&self.residual);
        // What this sweep has changed so far in H U at t_j, and its rate of change.
        let (mut change, mut rate) = (0.0, 0.0);
        for (j, pull) in pull.into_iter().enumerate() {
            self.residual[j] -= change;
            let u = self.u[j];
            let (n_neighbours, pairwise) = if j == 0 {
                (1.0, u - self.u[1])
            } else if j == last {
                (1.0, u - self.u[last - 1])
            } else {
                (2.0, 2.0 * u - self.u[j - 1] - self.u[j + 1])
            };
            let overlap = self.overlaps.after(j);
            let misfit = pull - change * overlap.with_displacement - rate * overlap.with_rate;
            let precision = weight * dt * overlap.with_rate + self.lambda * n_neighbours;
            let normal: f64 = self.rng.sample(StandardNormal);
            let step =
                (weight * misfit - self.lambda * pairwise) / precision + normal / precision.sqrt();
            self.u[j] = u + step;
            (change, rate) = turn.advance(change, rate + dt * step);
        }
    }

    /// Metropolis-Hastings for `lambda`: (2.13) as a function of `lambda`.
    fn draw_lambda(&mut self, adapt: bool) {
        let Hyperpriors { alpha1, beta1, .. } = *self.problem.hyper;
        let roughness: f64 = self.u.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
        let exponent = self.problem.power.exponent(self.u.len()) + alpha1 - 1.0;
        let log_density = |lambda: f64| exponent * lambda.ln() - lambda * (roughness + beta1) / 2.0;
        self.lambda = self.lambda_walk.step(self.lambda, log_density, adapt, &mut self.rng);
    }

    /// Metropolis-Hastings for `sigma`: (2.13) as a function of `sigma^2`, whose root is `sigma`.
    fn draw_sigma(&mut self, adapt: bool) {
        let Hyperpriors { alpha2, beta2, .. } = *self.problem.hyper;
        let misfit: f64 = self.residual.iter().map(|r| r * r).sum();
        let exponent = self.residual.len() as f64 / 2.0 + alpha2 + 1.0;
        let log_density =
            |variance: f64| -exponent * variance.ln() - (misfit + 2.0 * beta2) / (2.0 * variance);
        let variance = self.sigma * self.sigma;
        let next = self.variance_walk.step(variance, log_density, adapt, &mut self.rng);
        self.sigma = next.sqrt();
    }
}

/// Products of the column `H_j` with the free oscillations that start at `t_j`, for every `j`.
#[derive(Debug, Clone)]
struct Overlaps {
    /// Entry `k`: the products over the `k` samples that follow.
    over: Vec<Overlap>,
}

/// One column's products.
#[derive(Debug, Clone, Copy, Default)]
struct Overlap {
    /// With `cos(w (t - t_j))`, unit displacement.
    with_displacement: f64,
    /// With `sin(w (t - t_j))/w`, unit rate; times `dt`, the column's square.
    with_rate: f64,
}

impl Overlaps {
    fn new(convolution: &Convolution) -> Self {
        let (dt, w) = (convolution.step_s(), convolution.natural_frequency_rad_s());
        let mut sum = Overlap::default();
        let over = (0..convolution.n())
            .map(|k| {
                let (sin, cos) = (w * dt * k as f64).sin_cos();
                sum.with_displacement += dt * sin / w * cos;
                sum.with_rate += dt * sin / w * sin / w;
                sum
            })
            .collect();
        Self { over }
    }

    fn after(&self, j: usize) -> Overlap {
        self.over[self.over.len() - 1 - j]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `U` after one sweep whose conditionals are summed from a dense `H`, as printed.
    fn dense_sweep(start: &Gibbs, h: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let (n, g, weight) = (start.u.len(), start.problem.g, start.sigma.powi(-2));
        let (mut u, mut rng) = (start.u.clone(), start.rng.clone());
        for j in 0..n {
            let neighbours: Vec<usize> =
                [j.checked_sub(1), Some(j + 1)].into_iter().flatten().filter(|&k| k < n).collect();
            let (mut precision, mut linear) = (0.0, 0.0);
            for (i, g) in g.iter().enumerate() {
                let others: f64 = (0..n).filter(|&k| k != j).map(|k| h(i, k) * u[k]).sum();
                precision += weight * h(i, j) * h(i, j);
                linear += weight * h(i, j) * (g - others);
            }
            precision += start.lambda * neighbours.len() as f64;
            linear += start.lambda * neighbours.iter().map(|&k| u[k]).sum::<f64>();
            let normal: f64 = rng.sample(StandardNormal);
            u[j] = linear / precision + normal / precision.sqrt();
        }
        u
    }

    #[test]
    fn the_fast_sweep_draws_what_the_printed_conditionals_draw() {
        let (n, dt, w) = (60, 0.1, 6.136);
        let convolution = Convolution::new(n, dt, w).unwrap();
        let g: Vec<f64> = (0..n).map(|i| 0.05 * (0.37 * i as f64).sin()).collect();
        let problem = Problem {
            g: &g,
            convolution: &convolution,
            hyper: &Hyperpriors::PAPER,
            power: PriorPower::Printed,
        };
        let mut chain = Gibbs::new(problem, 3, 0);
        for sweep in 0..50 {
            let h = |i: usize, j: usize| {
                if j < i { dt * (w * dt * (i - j) as f64).sin() / w } else { 0.0 }
            };
            let dense = dense_sweep(&chain, h);
            chain.sweep(true);
            for (j, (fast, dense)) in chain.u.iter().zip(&dense).enumerate() {
                // Rounding of sums of n terms.
                let tolerance = 1e-11 * (1.0 + dense.abs());
                assert!((fast - dense).abs() < tolerance, "sweep {sweep} site {j}");
            }
        }
    }

    #[test]
    fn the_residual_does_not_drift() {
        let (n, dt, w) = (200, 0.02, 6.905);
        let convolution = Convolution::new(n, dt, w).unwrap();
        let g: Vec<f64> = (0..n).map(|i| 0.05 * (0.14 * i as f64).sin()).collect();
        let problem = Problem {
            g: &g,
            convolution: &convolution,
            hyper: &Hyperpriors::PAPER,
            power: PriorPower::Rank,
        };
        let mut chain = Gibbs::new(problem, 11, 2);
        for _ in 0..5_000 {
            chain.sweep(true);
        }
        let fitted = convolution.apply(&chain.u);
        for i in 0..n {
            // 5 000 additions of 1e-17 at random: 1e-15; a hundred times that to be safe.
            assert!((chain.residual[i] - (g[i] - fitted[i])).abs() < 1e-13, "sample {i}");
        }
    }
}
