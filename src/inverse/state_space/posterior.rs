//! The exact posterior of the moment history: one quadrature over the smoothness of the moment.
//!
//! METHOD of (2.8)-(2.14) without a chain: given the ratio of smoothness to noise the posterior is
//! normal, the noise integrates in closed form, and one dimension is left.

use statrs::function::gamma::ln_gamma;

use super::filter::{Column, Filtered, filter};
use super::smoother::smooth;
use super::transition::Transition;
use crate::inverse::paper::{Hyperpriors, PriorPower};

/// What is believed about smoothness and noise before the record is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hyperprior {
    /// Log-uniform in both: the answer does not depend on the units of roll or time.
    ScaleFree {
        /// Size of the roll [rad], which sets the prior width of the flat initial moment.
        roll_scale_rad: f64,
    },
    /// The paper's gamma and inverse-gamma pair (2.13).
    Conjugate {
        /// The four parameters.
        hyper: Hyperpriors,
        /// The power of the smoothness in (2.10).
        power: PriorPower,
        /// Natural frequency [rad/s], which turns scaled time back into the paper's units.
        natural_frequency_rad_s: f64,
    },
}

/// One node of the quadrature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Natural logarithm of the intensity of the moment's noise.
    pub log_intensity: f64,
    /// Logarithm of the posterior weight, up to a constant common to all orders.
    pub log_weight: f64,
    /// Posterior mean of the roll noise variance [rad2] at this node.
    pub noise_variance: f64,
}

/// Roll, rate and moment in scaled time with their standard deviations [rad].
#[derive(Debug, Clone, PartialEq)]
pub struct StatePosterior {
    /// Means, sample by sample.
    pub mean: Vec<[f64; 3]>,
    /// Standard deviations, sample by sample.
    pub sd: Vec<[f64; 3]>,
    /// Standard deviation of the roll noise [rad].
    pub noise_sd_rad: f64,
    /// The nodes that carry the weight.
    pub nodes: Vec<Node>,
    /// Logarithm of the evidence, up to a constant common to all orders.
    pub log_evidence: f64,
}

/// Range of the logarithm of the intensity that is searched. Below it the moment is a polynomial
/// over any record; above it the moment follows the noise of every sample.
const LOG_INTENSITY_RANGE: (f64, f64) = (-10.0, 14.0);

/// The inverse problem of one record under one family of priors.
pub struct MomentProblem<'a, F> {
    /// Scaled sample times.
    pub tau: &'a [f64],
    /// Record [rad].
    pub record: &'a [f64],
    /// Components of the initial state that are unknown.
    pub free_components: &'a [usize],
    /// The prior of a given intensity.
    pub prior: F,
    /// Belief about smoothness and noise.
    pub hyperprior: Hyperprior,
}

impl<F> MomentProblem<'_, F> {
    /// Solves the problem.
    pub fn solve<const N: usize, T: Transition<N>>(&self) -> StatePosterior
    where
        F: Fn(f64) -> T,
    {
        let nodes = self.nodes::<N, T>();
        let top = nodes.iter().map(|n| n.log_weight).fold(f64::NEG_INFINITY, f64::max);
        let spacing = nodes.get(1).map_or(1.0, |n| n.log_intensity - nodes[0].log_intensity);
        let total: f64 = nodes.iter().map(|n| (n.log_weight - top).exp()).sum();
        let columns = self.columns();
        let n_flat = columns.len() - 1;
        let mut mean = vec![[0.0; 3]; self.tau.len()];
        let mut second = mean.clone();
        let mut noise_variance = 0.0;
        for node in &nodes {
            let share = (node.log_weight - top).exp() / total;
            noise_variance += share * node.noise_variance;
            let prior = (self.prior)(node.log_intensity.exp());
            let (filtered, smoothed) = smooth(&prior, self.tau, &columns);
            let weights = filtered.triangle.explained_by(n_flat, n_flat);
            let inverse = filtered.triangle.inverse_columns(n_flat);
            for (i, (mean, second)) in mean.iter_mut().zip(&mut second).enumerate() {
                for k in 0..3 {
                    let m = smoothed.mean(i, k, &weights);
                    let v = smoothed.variance(i, k, &inverse) * node.noise_variance;
                    mean[k] += share * m;
                    second[k] += share * (v + m * m);
                }
            }
        }
        let sd = mean
            .iter()
            .zip(&second)
            .map(|(m, s)| std::array::from_fn(|k| (s[k] - m[k] * m[k]).max(0.0).sqrt()))
            .collect();
        StatePosterior {
            mean,
            sd,
            noise_sd_rad: noise_variance.sqrt(),
            log_evidence: top + (total * spacing).ln(),
            nodes,
        }
    }

    /// The flat columns, then the record.
    fn columns(&self) -> Vec<Column<'_>> {
        let free = self.free_components.iter().map(|&c| Column::InitialState(c));
        free.chain([Column::Record(self.record)]).collect()
    }

    /// Nodes around the mode, evenly spaced, that hold all but a millionth of the weight.
    fn nodes<const N: usize, T: Transition<N>>(&self) -> Vec<Node>
    where
        F: Fn(f64) -> T,
    {
        let at = |x: f64| self.node::<N, T>(x);
        let (low, high) = LOG_INTENSITY_RANGE;
        let coarse: Vec<Node> =
            (0..=24).map(|i| at(low + f64::from(i) * (high - low) / 24.0)).collect();
        let best = coarse
            .iter()
            .copied()
            .reduce(|a, b| if b.log_weight > a.log_weight { b } else { a })
            .expect("the search has nodes");
        // Newton steps on the parabola through three close points find the mode and its width.
        let mut mode = best.log_intensity;
        let mut width = 0.5;
        for _ in 0..3 {
            let (left, here, right) = (at(mode - 0.25), at(mode), at(mode + 0.25));
            let slope = (right.log_weight - left.log_weight) / 0.5;
            let bend = (right.log_weight - 2.0 * here.log_weight + left.log_weight) / 0.0625;
            if bend >= 0.0 {
                break;
            }
            width = (-bend).sqrt().recip().clamp(0.01, 2.0);
            mode = (mode - (slope / bend).clamp(-1.0, 1.0)).clamp(low, high);
        }
        // The weight is close to a normal in the logarithm: a trapezoidal rule of steps 0.8 sd over
        // +-5 sd has an error far below the weights it drops.
        (-6..=6).map(|i| at(mode + 0.8 * width * f64::from(i))).collect()
    }

    fn node<const N: usize, T: Transition<N>>(&self, log_intensity: f64) -> Node
    where
        F: Fn(f64) -> T,
    {
        let prior = (self.prior)(log_intensity.exp());
        let columns = self.columns();
        let filtered = filter(&prior, self.tau, &columns, None);
        self.weigh(log_intensity, &filtered, columns.len() - 1)
    }

    fn weigh(&self, log_intensity: f64, filtered: &Filtered, n_flat: usize) -> Node {
        let triangle = &filtered.triangle;
        let residual = triangle.at(n_flat, n_flat).powi(2);
        let log_flat: f64 = (0..n_flat).map(|i| triangle.at(i, i).abs().ln()).sum();
        let freedom = filtered.n_samples as f64 - n_flat as f64;
        let common = -0.5 * filtered.log_determinant - log_flat;
        let (log_weight, shape, scale) = match self.hyperprior {
            Hyperprior::ScaleFree { roll_scale_rad } => {
                let (shape, scale) = (0.5 * freedom, 0.5 * residual);
                // Each flat component stands for a normal prior of this width.
                let flat_prior = -(n_flat as f64) * roll_scale_rad.ln();
                (common + flat_prior + ln_gamma(shape) - shape * scale.ln(), shape, scale)
            }
            Hyperprior::Conjugate { hyper, power, natural_frequency_rad_s } => {
                let log_ratio = -2.0 * log_intensity - 4.0 * natural_frequency_rad_s.ln();
                // The flat constant of the moment has already taken the rank's share.
                let n = filtered.n_samples;
                let excess = power.exponent(n) - PriorPower::Rank.exponent(n);
                let power = hyper.alpha1 + excess;
                let shape = 0.5 * freedom + power + hyper.alpha2;
                let scale = 0.5 * (residual + 2.0 * hyper.beta2 + log_ratio.exp() * hyper.beta1);
                (common + power * log_ratio - shape * scale.ln(), shape, scale)
            }
        };
        Node { log_intensity, log_weight, noise_variance: scale / (shape - 1.0) }
    }
}
