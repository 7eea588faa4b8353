//! The posterior (2.13) by dense algebra and quadrature, for runs short enough to afford it.
//!
//! With `rho = lambda sigma^2`, `U` given `rho` and `sigma^2` is normal and `sigma^2` given `rho`
//! is inverse gamma, so what is left is one integral over `ln rho`. The trapezium rule does it to
//! rounding, because the integrand is smooth and dies at both ends.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Col, Mat, Side};
use rolltank::inverse::paper::{Hyperpriors, PriorPower};
use statrs::distribution::{ContinuousCDF, StudentsT};
use statrs::function::gamma::ln_gamma;

/// Exact posterior moments of `U`, `sigma` and `lambda`.
pub(crate) struct DensePosterior {
    /// Mean of each `U` [rad/s2].
    pub(crate) mean: Vec<f64>,
    /// Standard deviation of each `U` [rad/s2].
    pub(crate) sd: Vec<f64>,
    /// Mean and standard deviation of the noise `sigma` [rad].
    pub(crate) sigma: (f64, f64),
    /// Mean and standard deviation of the prior precision `lambda` [s4].
    pub(crate) lambda: (f64, f64),
    nodes: Vec<Node>,
}

impl DensePosterior {
    /// Probability that `U[site]` lies below `u`.
    pub(crate) fn cdf(&self, site: usize, u: f64) -> f64 {
        let below = |node: &Node| {
            let scale = (node.b / node.a * node.inverse_diagonal[site]).sqrt();
            let student = StudentsT::new(node.mean[site], scale, 2.0 * node.a)
                .expect("scale and degrees of freedom are positive");
            node.weight * student.cdf(u)
        };
        self.nodes.iter().map(below).sum()
    }
}

/// Everything known at one `rho`.
struct Node {
    rho: f64,
    /// Log density of `ln rho`, later its normalised weight.
    weight: f64,
    /// `sigma^2 | rho` is inverse gamma with shape `a` and scale `b`.
    a: f64,
    b: f64,
    mean: Vec<f64>,
    inverse_diagonal: Vec<f64>,
}

/// The posterior of `g` [rad] sampled every `step_s` [s], natural frequency `w` [rad/s].
pub(crate) fn dense_posterior(
    g: &[f64],
    step_s: f64,
    w: f64,
    hyper: &Hyperpriors,
    rank_power: PriorPower,
) -> DensePosterior {
    const NEGLIGIBLE: f64 = -40.0;
    const N_NODES: usize = 300;
    let model = Model::new(g, step_s, w, hyper, rank_power);
    let coarse: Vec<(f64, f64)> = (-60..=60)
        .filter_map(|k| {
            let log_rho = 0.5 * f64::from(k);
            model.node(log_rho, false).map(|node| (log_rho, node.weight))
        })
        .collect();
    let peak = coarse.iter().map(|(_, weight)| *weight).fold(f64::NEG_INFINITY, f64::max);
    let held: Vec<f64> =
        coarse.iter().filter(|(_, weight)| weight - peak > NEGLIGIBLE).map(|(r, _)| *r).collect();
    let (first, last) = (held[0], held[held.len() - 1]);
    assert!(coarse[0].0 < first && last < 30.0, "rho from {first} to {last} leaves the scan");

    let place = |k: usize| first - 0.5 + (last - first + 1.0) * k as f64 / (N_NODES - 1) as f64;
    let mut nodes: Vec<Node> = (0..N_NODES).filter_map(|k| model.node(place(k), true)).collect();
    let peak = nodes.iter().map(|node| node.weight).fold(f64::NEG_INFINITY, f64::max);
    for node in &mut nodes {
        node.weight = (node.weight - peak).exp();
    }
    let total: f64 = nodes.iter().map(|node| node.weight).sum();
    for node in &mut nodes {
        node.weight /= total;
    }
    moments(nodes)
}

/// Mixes the nodes.
fn moments(nodes: Vec<Node>) -> DensePosterior {
    let expect = |value: &dyn Fn(&Node) -> f64| -> f64 {
        nodes.iter().map(|node| node.weight * value(node)).sum()
    };
    let n = nodes[0].mean.len();
    let mean: Vec<f64> = (0..n).map(|i| expect(&|node| node.mean[i])).collect();
    let sd = (0..n)
        .map(|i| {
            let within = expect(&|node| node.b / (node.a - 1.0) * node.inverse_diagonal[i]);
            (within + expect(&|node| (node.mean[i] - mean[i]).powi(2))).sqrt()
        })
        .collect();
    let sigma = expect(&|node| (ln_gamma(node.a - 0.5) - ln_gamma(node.a)).exp() * node.b.sqrt());
    let variance = expect(&|node| node.b / (node.a - 1.0));
    let lambda = expect(&|node| node.rho * node.a / node.b);
    let lambda_squared = expect(&|node| (node.rho / node.b).powi(2) * node.a * (node.a + 1.0));
    DensePosterior {
        mean,
        sd,
        sigma: (sigma, (variance - sigma * sigma).sqrt()),
        lambda: (lambda, (lambda_squared - lambda * lambda).sqrt()),
        nodes,
    }
}

/// The matrices of (2.12), written out.
struct Model<'a> {
    h: Mat<f64>,
    hh: Mat<f64>,
    walk: Mat<f64>,
    hg: Col<f64>,
    g: Col<f64>,
    hyper: &'a Hyperpriors,
    power: f64,
}

impl<'a> Model<'a> {
    fn new(g: &[f64], dt: f64, w: f64, hyper: &'a Hyperpriors, power: PriorPower) -> Self {
        let n = g.len();
        let h =
            Mat::from_fn(
                n,
                n,
                |i, j| {
                    if j < i { dt * (w * dt * (i - j) as f64).sin() / w } else { 0.0 }
                },
            );
        let walk = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 if i == 0 || i == n - 1 => 1.0,
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let g = Col::from_fn(n, |i| g[i]);
        let (hh, hg) = (h.transpose() * &h, h.transpose() * &g);
        Self { h, hh, walk, hg, g, hyper, power: power.exponent(n) }
    }

    /// The node at `ln rho`; none where the matrix is singular to rounding.
    fn node(&self, log_rho: f64, with_inverse: bool) -> Option<Node> {
        let Hyperpriors { alpha1, beta1, alpha2, beta2 } = *self.hyper;
        let (rho, n) = (log_rho.exp(), self.g.nrows());
        let precision = &self.hh + faer::Scale(rho) * &self.walk;
        let factor = precision.llt(Side::Lower).ok()?;
        let inverse = if with_inverse { factor.inverse() } else { Mat::zeros(0, 0) };
        let mean = faer::linalg::solvers::Solve::solve(&factor, &self.hg);
        let residual = &self.g - &self.h * &mean;
        let rough = mean.transpose() * &self.walk * &mean;
        let b = (residual.squared_norm_l2() + rho * rough + 2.0 * beta2 + rho * beta1) / 2.0;
        // m = n measurements; lambda^power instead of lambda^(n/2) moves the shape as well.
        let a = alpha1 + alpha2 + self.power;
        let half_log_det: f64 = (0..n).map(|i| factor.L()[(i, i)].ln()).sum();
        Some(Node {
            rho,
            weight: (self.power + alpha1) * log_rho - half_log_det - a * b.ln(),
            a,
            b,
            mean: mean.iter().copied().collect(),
            inverse_diagonal: inverse.diagonal().column_vector().iter().copied().collect(),
        })
    }
}
