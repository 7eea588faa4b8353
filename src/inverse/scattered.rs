//! Least squares of runs that scatter by more than their own noise, by an amount that is unknown.
//!
//! Runs of one Froude number differ by more than their own intervals (the paper's by 50 to 100
//! times), so the scatter from run to run is an unknown, with the scale-free prior that makes the
//! intervals Student's when it dominates.

use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::estimate::Estimate;
use super::mixture::{self, Component};

/// One node of the scatter: what the coefficients are, given it.
pub struct Node {
    pub(super) weight: f64,
    pub(super) scatter: f64,
    pub(super) mean: Vec<f64>,
    pub(super) covariance: Mat<f64>,
}

/// Number of nodes of the scatter, evenly spaced in its logarithm.
const N_NODES: usize = 80;

/// Estimate of a linear combination of the coefficients.
pub fn combination(nodes: &[Node], weights: &[f64]) -> Estimate {
    let component = |node: &Node| Component {
        weight: node.weight,
        mean: node.mean.iter().zip(weights).map(|(m, w)| m * w).sum(),
        sd: quadratic(&node.covariance, weights).sqrt(),
    };
    mixture::estimate(&nodes.iter().map(component).collect::<Vec<_>>())
}

/// Posterior probability that a linear combination of the coefficients is above zero.
pub fn probability_positive(nodes: &[Node], weights: &[f64]) -> f64 {
    let unit = Normal::standard();
    let each = nodes.iter().map(|node| {
        let mean: f64 = node.mean.iter().zip(weights).map(|(m, w)| m * w).sum();
        let sd = quadratic(&node.covariance, weights).sqrt().max(f64::MIN_POSITIVE);
        node.weight * unit.cdf(mean / sd)
    });
    each.sum()
}

pub(super) fn quadratic(matrix: &Mat<f64>, x: &[f64]) -> f64 {
    let mut sum = 0.0;
    for i in 0..x.len() {
        for j in 0..x.len() {
            sum += x[i] * matrix[(i, j)] * x[j];
        }
    }
    sum.max(0.0)
}

/// Posterior of `y_i = x_i c + scatter + noise_i`, node by node of the scatter; `values` are the
/// `y_i` with the standard deviation of their noise, more of them than of the coefficients.
pub fn nodes(rows: &[Vec<f64>], values: &[(f64, f64)]) -> Vec<Node> {
    let n = rows.len();
    let (p, freedom) = (rows[0].len(), n - rows[0].len());
    let size = typical(values);
    let noise = values.iter().map(|v| v.1).sum::<f64>() / n as f64;
    // Below a tenth of the runs' own noise a scatter changes nothing; above the Student tail of the
    // fewest degrees of freedom nothing is left.
    let tail = StudentsT::new(0.0, 1.0, freedom as f64).map_or(100.0, |t| t.inverse_cdf(0.9999));
    let low = (0.1 * noise).max(1e-6 * size).ln();
    let high = (size * tail.min(1e3)).ln();
    let mut nodes: Vec<Node> = (0..N_NODES)
        .map(|i| {
            let scatter = (low + (high - low) * i as f64 / (N_NODES - 1) as f64).exp();
            node(rows, values, scatter, p)
        })
        .collect();
    let top = nodes.iter().map(|n| n.weight).fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = nodes.iter().map(|n| (n.weight - top).exp()).sum();
    for node in &mut nodes {
        node.weight = (node.weight - top).exp() / total;
    }
    nodes.retain(|n| n.weight > 1e-9);
    nodes
}

/// The same under a prior that is scale-free in scatter and noise together.
///
/// The scale-free prior of the scatter alone leaves much room far below the noise, and two repeats
/// that agree by chance would then make the scatter nil: with two degrees of freedom and a scatter
/// of five times the noise, 95 % intervals held 90 %.
pub fn never_nil(mut nodes: Vec<Node>, values: &[(f64, f64)]) -> Vec<Node> {
    let noise = values.iter().map(|value| value.1.powi(2)).sum::<f64>() / values.len() as f64;
    for node in &mut nodes {
        let scatter = node.scatter.powi(2);
        node.weight *= scatter / (scatter + noise);
    }
    let total: f64 = nodes.iter().map(|node| node.weight).sum();
    for node in &mut nodes {
        node.weight /= total;
    }
    nodes
}

/// Spread of the values, or their size when they are all alike.
fn typical(values: &[(f64, f64)]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().map(|v| v.0).sum::<f64>() / n;
    let spread = (values.iter().map(|v| (v.0 - mean).powi(2)).sum::<f64>() / n).sqrt();
    spread.max(1e-3 * mean.abs()).max(f64::MIN_POSITIVE)
}

fn node(rows: &[Vec<f64>], values: &[(f64, f64)], scatter: f64, p: usize) -> Node {
    let mut normal = Mat::<f64>::zeros(p, p);
    let mut right = Mat::<f64>::zeros(p, 1);
    let mut weight = 0.0;
    for (row, (value, sd)) in rows.iter().zip(values) {
        let variance = scatter.powi(2) + sd.powi(2);
        weight -= 0.5 * variance.ln();
        for i in 0..p {
            right[(i, 0)] += row[i] * value / variance;
            for j in 0..p {
                normal[(i, j)] += row[i] * row[j] / variance;
            }
        }
    }
    let factor = normal.partial_piv_lu();
    let mean = factor.solve(&right);
    let covariance = factor.inverse();
    for (row, (value, sd)) in rows.iter().zip(values) {
        let fitted: f64 = (0..p).map(|i| row[i] * mean[(i, 0)]).sum();
        weight -= 0.5 * (value - fitted).powi(2) / (scatter.powi(2) + sd.powi(2));
    }
    weight -= 0.5 * normal.determinant().ln();
    Node { weight, scatter, mean: (0..p).map(|i| mean[(i, 0)]).collect(), covariance }
}
