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
/// Where what is believed of the intensity ends: below it all nodes would weigh the same. A moment
/// that is read directly, its rate a walk of this intensity `q`, leaves a line by
/// `q sqrt(tau^3 / 3)`, the deviation of a walk summed up: over 160 periods by 0.002 of a reading's
/// noise.
const LEAST_LOG_INTENSITY: f64 = -16.0;

/// How finely the intensity is integrated over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadrature {
    /// Step, in standard deviations of the logarithm of the intensity at its mode.
    pub step_sd: f64,
    /// Nodes are added on both sides until they weigh less than this share of the heaviest.
    pub negligible: f64,
}

impl Quadrature {
    /// What a band needs: its ends are right to a thousandth of their distance.
    pub const BAND: Self = Self { step_sd: 1.5, negligible: 1e-2 };
    /// As many digits as the arithmetic carries.
    pub const EXACT: Self = Self { step_sd: 0.4, negligible: 1e-15 };
}

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
    /// How finely the smoothness is integrated over.
    pub quadrature: Quadrature,
}

/// The bell curve through three nodes.
struct Bell {
    /// Logarithm of the intensity at its top.
    mode: f64,
    /// Its standard deviation.
    width: f64,
}

impl Bell {
    fn through([left, middle, right]: &[Node; 3]) -> Self {
        let slope = |a: &Node, b: &Node| {
            (b.log_weight - a.log_weight) / (b.log_intensity - a.log_intensity)
        };
        let (before, after) = (slope(left, middle), slope(middle, right));
        let bend = 2.0 * (after - before) / (right.log_intensity - left.log_intensity);
        if bend >= 0.0 {
            // No top among them: the nodes may lie anywhere that the prior allows.
            return Self { mode: middle.log_intensity, width: 1.0 };
        }
        // The slopes are those half-way between the nodes.
        let between = 0.5 * (left.log_intensity + middle.log_intensity);
        Self { mode: between - before / bend, width: (-bend).sqrt().recip().clamp(0.01, 2.0) }
    }
}

/// The nodes of a quadrature with what they sum to.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighed {
    /// The nodes, in order of their intensity.
    pub nodes: Vec<Node>,
    /// Logarithm of the evidence, up to a constant common to all orders.
    pub log_evidence: f64,
}

impl<F> MomentProblem<'_, F> {
    /// Solves the problem.
    pub fn solve<const N: usize, T: Transition<N>>(&self) -> StatePosterior
    where
        F: Fn(f64) -> T,
    {
        self.smooth(self.weigh::<N, T>())
    }

    /// The posterior of roll, rate and moment over the nodes of [`MomentProblem::weigh`].
    pub fn smooth<const N: usize, T: Transition<N>>(&self, weighed: Weighed) -> StatePosterior
    where
        F: Fn(f64) -> T,
    {
        let Weighed { nodes, log_evidence } = weighed;
        let top = nodes.iter().map(|n| n.log_weight).fold(f64::NEG_INFINITY, f64::max);
        let columns = self.columns();
        let n_flat = columns.len() - 1;
        let mut mean = vec![[0.0; 3]; self.tau.len()];
        let mut second = mean.clone();
        let mut noise_variance = 0.0;
        // Moments about the heaviest node's mean, so that no digits are lost.
        let mut centre: Vec<[f64; 3]> = Vec::new();
        let least = top + self.quadrature.negligible.ln();
        let mut order: Vec<&Node> = nodes.iter().filter(|n| n.log_weight > least).collect();
        let total: f64 = order.iter().map(|n| (n.log_weight - top).exp()).sum();
        order.sort_by(|a, b| b.log_weight.total_cmp(&a.log_weight));
        for node in order {
            let share = (node.log_weight - top).exp() / total;
            noise_variance += share * node.noise_variance;
            let prior = (self.prior)(node.log_intensity.exp());
            let (filtered, smoothed) = smooth(&prior, self.tau, &columns);
            let weights = filtered.triangle.explained_by(n_flat, n_flat);
            let inverse = filtered.triangle.inverse_columns(n_flat);
            let value = |i: usize| [0, 1, 2].map(|k| smoothed.mean(i, k, &weights));
            if centre.is_empty() {
                centre = (0..self.tau.len()).map(value).collect();
            }
            for (i, (mean, second)) in mean.iter_mut().zip(&mut second).enumerate() {
                for (k, m) in value(i).into_iter().enumerate() {
                    let from_centre = m - centre[i][k];
                    let v = smoothed.variance(i, k, &inverse) * node.noise_variance;
                    mean[k] += share * from_centre;
                    second[k] += share * (v + from_centre * from_centre);
                }
            }
        }
        let spread = |(m, s): (&[f64; 3], &[f64; 3])| {
            std::array::from_fn(|k| (s[k] - m[k] * m[k]).max(0.0).sqrt())
        };
        let sd = mean.iter().zip(&second).map(spread).collect();
        let whole = |(c, m): (&[f64; 3], &[f64; 3])| std::array::from_fn(|k| c[k] + m[k]);
        StatePosterior {
            mean: centre.iter().zip(&mean).map(whole).collect(),
            sd,
            noise_sd_rad: noise_variance.sqrt(),
            log_evidence,
            nodes,
        }
    }

    /// The flat columns, then the record.
    fn columns(&self) -> Vec<Column<'_>> {
        let free = self.free_components.iter().map(|&c| Column::InitialState(c));
        free.chain([Column::Record(self.record)]).collect()
    }

    /// Evenly spaced nodes about the mode that hold the weight, and the evidence.
    pub fn weigh<const N: usize, T: Transition<N>>(&self) -> Weighed
    where
        F: Fn(f64) -> T,
    {
        let at = |x: f64| self.node::<N, T>(x);
        let (top, mut width) = Self::summit(&at);
        // A trapezoidal rule over a bell curve gains digits with the square of its fineness.
        let mut step = self.quadrature.step_sd * width;
        let mut sides = [-step, step].map(|x| at(top.log_intensity + x));
        for _ in 0..3 {
            let seen = Bell::through(&[sides[0], top, sides[1]]);
            // A step a fifth too wide costs a digit or two, one too narrow a node or two.
            if (0.8..1.3).contains(&(seen.width / width)) {
                break;
            }
            width = seen.width;
            step = self.quadrature.step_sd * width;
            sides = [-step, step].map(|x| at(top.log_intensity + x));
        }
        let [left, right] = sides;
        let least = top.log_weight + self.quadrature.negligible.ln();
        let side = |first: Node, sign: f64| {
            let mut nodes = vec![first];
            for i in 2..200_u32 {
                let next = top.log_intensity + sign * step * f64::from(i);
                if nodes[nodes.len() - 1].log_weight <= least || next < LEAST_LOG_INTENSITY {
                    break;
                }
                nodes.push(at(next));
            }
            nodes
        };
        let nodes: Vec<Node> =
            side(left, -1.0).into_iter().rev().chain([top]).chain(side(right, 1.0)).collect();
        let top = nodes.iter().map(|n| n.log_weight).fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = nodes.iter().map(|n| (n.log_weight - top).exp()).sum();
        Weighed { nodes, log_evidence: top + (total * step).ln() }
    }

    /// A node near the mode and the width there: strides uphill, then parabolas between them.
    fn summit(at: &impl Fn(f64) -> Node) -> (Node, f64) {
        const N_PARABOLAS_MAX: usize = 8;
        let mut three = Self::uphill(at);
        let mut bell = Bell::through(&three);
        for _ in 0..N_PARABOLAS_MAX {
            let [left, best, right] = three;
            let (low, high) = (left.log_intensity, right.log_intensity);
            let away = (bell.mode - best.log_intensity).abs();
            if away < 0.6 * bell.width || !(low < bell.mode && bell.mode < high) {
                break;
            }
            let next = at(bell.mode);
            three = match (bell.mode > best.log_intensity, next.log_weight > best.log_weight) {
                (true, true) => [best, next, right],
                (true, false) => [left, best, next],
                (false, true) => [left, next, best],
                (false, false) => [next, best, right],
            };
            bell = Bell::through(&three);
        }
        (three[1], bell.width)
    }

    /// The best of evenly spaced nodes between its neighbours, by strides uphill from the middle of
    /// the range.
    fn uphill(at: &impl Fn(f64) -> Node) -> [Node; 3] {
        const STRIDE: f64 = 2.0;
        let (low, high) = LOG_INTENSITY_RANGE;
        let middle = 0.5 * (low + high);
        let mut three = [-STRIDE, 0.0, STRIDE].map(|x| at(middle + x));
        loop {
            let [left, best, right] = three;
            let (next, sign) =
                if right.log_weight > left.log_weight { (right, 1.0) } else { (left, -1.0) };
            let beyond = next.log_intensity + sign * STRIDE;
            if next.log_weight <= best.log_weight || !(low..=high).contains(&beyond) {
                return three;
            }
            let end = at(beyond);
            three = if sign > 0.0 { [best, next, end] } else { [end, next, best] };
        }
    }

    fn node<const N: usize, T: Transition<N>>(&self, log_intensity: f64) -> Node
    where
        F: Fn(f64) -> T,
    {
        let prior = (self.prior)(log_intensity.exp());
        let columns = self.columns();
        let filtered = filter(&prior, self.tau, &columns, None);
        self.node_of(log_intensity, &filtered, columns.len() - 1)
    }

    fn node_of(&self, log_intensity: f64, filtered: &Filtered, n_flat: usize) -> Node {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::state_space::drifting::Drifting;

    #[test]
    fn where_nothing_but_noise_is_read_few_nodes_tell_so() {
        // Every rate of the moment's walk below some weighs the same: over the record it is none.
        let tau: Vec<f64> = (0..1000).map(|k| 0.08 * f64::from(k)).collect();
        let record: Vec<f64> = (0..1000).map(|k| (7.3 * f64::from(k * k)).sin()).collect();
        let problem = MomentProblem {
            tau: &tau,
            record: &record,
            free_components: &[0, 1],
            prior: |intensity: f64| Drifting { intensity },
            hyperprior: Hyperprior::ScaleFree { roll_scale_rad: 1.0 },
            quadrature: Quadrature::BAND,
        };
        let told = problem.solve::<2, Drifting>();
        // A step is at most three wide, and from the middle of the range to its end are 18.
        assert!(told.nodes.len() < 20, "{} nodes", told.nodes.len());
        let is_nought = |(mean, sd): (&[f64; 3], &[f64; 3])| mean[2].abs() < 3.0 * sd[2];
        assert!(told.mean.iter().zip(&told.sd).all(is_nought));
    }
}
