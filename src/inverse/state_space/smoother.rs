//! The backward pass: what every sample says about the state at each instant.
//!
//! Modified Bryson-Frazier form (Bierman, Factorization Methods for Discrete Sequential
//! Estimation, 1977, ch. X): an adjoint runs back along the filter's trail, so no covariance is
//! inverted.

use super::filter::{Column, Filtered, Trail, Triangle, filter};
use super::matrix::{Matrix, apply, apply_transposed, congruence, identity};
use super::transition::Transition;

/// Posterior of roll, rate and moment in scaled time, given the hyperparameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// Means of roll, rate and moment [rad], sample by sample, for each record asked for.
    pub means: Vec<Vec<[f64; 3]>>,
    /// Variances of roll, rate and moment in units of the roll noise's variance, flat columns
    /// included.
    pub variances: Vec<[f64; 3]>,
}

/// Filters and smooths `records` that share the flat columns `flat`.
///
/// Every record is explained as `flat` columns with unknown weights plus the response to the
/// moment; the weights are their generalised least squares.
pub fn smooth<const N: usize>(
    prior: &impl Transition<N>,
    tau: &[f64],
    flat: &[Column<'_>],
    records: &[&[f64]],
) -> (Filtered, Smoothed) {
    let columns: Vec<Column<'_>> =
        flat.iter().copied().chain(records.iter().map(|r| Column::Record(r))).collect();
    let mut trail = Trail::default();
    let filtered = filter(prior, tau, &columns, Some(&mut trail));
    let flat_count = flat.len();
    let weights: Vec<Vec<f64>> = (0..records.len())
        .map(|r| explained_by(&filtered.triangle, flat_count, flat_count + r))
        .collect();
    let smoothed = run_back(&trail, &filtered.triangle, flat_count, &weights);
    (filtered, smoothed)
}

/// Weights that cancel column `record` best by the first `count` columns.
pub fn explained_by(triangle: &Triangle, count: usize, record: usize) -> Vec<f64> {
    let mut weights = vec![0.0; count];
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|j| triangle.at(i, j) * weights[j]).sum();
        weights[i] = -(triangle.at(i, record) + known) / triangle.at(i, i);
    }
    weights
}

fn run_back<const N: usize>(
    trail: &Trail<N>,
    triangle: &Triangle,
    flat_count: usize,
    weights: &[Vec<f64>],
) -> Smoothed {
    let n_samples = trail.roots.len();
    let n_columns = flat_count + weights.len();
    let mut adjoints = vec![[0.0; N]; n_columns];
    let mut information: Matrix<N> = [[0.0; N]; N];
    let mut means = vec![vec![[0.0; 3]; n_samples]; weights.len()];
    let mut variances = vec![[0.0; 3]; n_samples];
    let mut smoothed = vec![[0.0; N]; n_columns];
    for i in (0..n_samples).rev() {
        let root = &trail.roots[i];
        let variance = 1.0 + root[0][0] * root[0][0];
        // I - K H: the gain acts on the roll alone.
        let mut kept = identity::<N>();
        for (row, from) in kept.iter_mut().zip(root) {
            row[0] -= from[0] * root[0][0] / variance;
        }
        information = congruence(&kept, &information);
        information[0][0] += 1.0 / variance;
        let states = &trail.states[i * n_columns..(i + 1) * n_columns];
        let innovations = &trail.innovations[i * n_columns..(i + 1) * n_columns];
        for (c, adjoint) in adjoints.iter_mut().enumerate() {
            *adjoint = apply_transposed(&kept, adjoint);
            adjoint[0] -= innovations[c] / variance;
            let pulled = apply(root, &apply_transposed(root, adjoint));
            smoothed[c] = std::array::from_fn(|k| states[c][k] - pulled[k]);
        }
        for (mean, weights) in
            means.iter_mut().zip(weights).enumerate().map(|(r, (m, w))| (&mut m[i], (r, w)))
        {
            let (record, weights) = weights;
            for (k, mean) in mean.iter_mut().enumerate() {
                let flat: f64 = weights.iter().zip(&smoothed).map(|(w, s)| w * s[k]).sum();
                *mean = smoothed[flat_count + record][k] + flat;
            }
        }
        for (k, out) in variances[i].iter_mut().enumerate() {
            *out = state_variance(root, &information, k)
                + flat_variance(triangle, &smoothed[..flat_count], k);
        }
        if i > 0 {
            let step = &trail.steps[i];
            for adjoint in &mut adjoints {
                *adjoint = apply_transposed(&step.f, adjoint);
            }
            information = congruence(&step.f, &information);
        }
    }
    Smoothed { means, variances }
}

/// Variance of component `k` with the flat columns' weights known: `P - P J P`.
fn state_variance<const N: usize>(root: &Matrix<N>, information: &Matrix<N>, k: usize) -> f64 {
    let row = root[k];
    let inner = congruence(root, information);
    let seen: f64 =
        (0..N).map(|a| row[a] * (0..N).map(|b| inner[a][b] * row[b]).sum::<f64>()).sum();
    (row.iter().map(|v| v * v).sum::<f64>() - seen).max(0.0)
}

/// Variance that component `k` has from not knowing the weights of the flat columns.
fn flat_variance<const N: usize>(triangle: &Triangle, responses: &[[f64; N]], k: usize) -> f64 {
    // Solves R' z = response, so that z'z = response' (R'R)^-1 response.
    let mut z = vec![0.0; responses.len()];
    for i in 0..responses.len() {
        let known: f64 = (0..i).map(|j| triangle.at(j, i) * z[j]).sum();
        z[i] = (responses[i][k] - known) / triangle.at(i, i);
    }
    z.iter().map(|z| z * z).sum()
}
