//! The backward pass: what every sample says about the state at each instant.
//!
//! Modified Bryson-Frazier form (Bierman, Factorization Methods for Discrete Sequential
//! Estimation, 1977, ch. X): an adjoint runs back along the filter's trail, so no covariance is
//! inverted.

use super::filter::{Column, Filtered, Trail, filter, same};
use super::matrix::{Matrix, apply, apply_transposed, congruence, identity};
use super::transition::Transition;

/// Roll, rate and moment in scaled time [rad], given the hyperparameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// The response that explains each column best, sample by sample, `n_columns` each.
    pub columns: Vec<[f64; 3]>,
    /// Number of columns.
    pub n_columns: usize,
    /// Variances with the columns' weights known, in units of the roll noise's variance.
    pub variances: Vec<[f64; 3]>,
}

impl Smoothed {
    /// The columns' responses at one sample.
    pub fn at(&self, sample: usize) -> &[[f64; 3]] {
        &self.columns[sample * self.n_columns..(sample + 1) * self.n_columns]
    }

    /// Component `k` at one sample of a record that is the last column, the others weighing
    /// `weights`.
    pub fn mean(&self, sample: usize, k: usize, weights: &[f64]) -> f64 {
        let columns = self.at(sample);
        let flat: f64 = weights.iter().zip(columns).map(|(w, column)| w * column[k]).sum();
        columns[self.n_columns - 1][k] + flat
    }

    /// Variance of component `k` at one sample, the flat columns' weights unknown; `inverse` holds
    /// the columns of their inverse triangle.
    pub fn variance(&self, sample: usize, k: usize, inverse: &[Vec<f64>]) -> f64 {
        let columns = self.at(sample);
        let share = |inverse: &Vec<f64>| -> f64 {
            inverse.iter().zip(columns).map(|(weight, column)| weight * column[k]).sum()
        };
        self.variances[sample][k] + inverse.iter().map(|i| share(i).powi(2)).sum::<f64>()
    }
}

/// Filters and smooths `columns` together.
pub fn smooth<const N: usize>(
    prior: &impl Transition<N>,
    tau: &[f64],
    columns: &[Column<'_>],
) -> (Filtered, Smoothed) {
    let mut trail = Trail::default();
    let filtered = filter(prior, tau, columns, Some(&mut trail));
    let smoothed = run_back(&trail, columns.len(), prior.places());
    (filtered, smoothed)
}

fn run_back<const N: usize>(trail: &Trail<N>, n_columns: usize, places: [usize; 3]) -> Smoothed {
    let n_samples = trail.roots.len();
    let mut adjoints = vec![[0.0; N]; n_columns];
    let mut information: Matrix<N> = [[0.0; N]; N];
    let mut variances = vec![[0.0; 3]; n_samples];
    let mut smoothed = vec![[0.0; 3]; n_samples * n_columns];
    let mut kept = identity::<N>();
    // Where gain and information repeat themselves, so do the variances.
    let mut settled = false;
    for i in (0..n_samples).rev() {
        let root = trail.roots.at(i);
        let variance = 1.0 + root[0][0] * root[0][0];
        let again = i + 1 < n_samples && trail.roots.is_same(i, i + 1);
        settled &= again && trail.steps.is_same(i, i + 1);
        if !again {
            // I - K H: the gain acts on the roll alone.
            kept = identity::<N>();
            for (row, from) in kept.iter_mut().zip(root) {
                row[0] -= from[0] * root[0][0] / variance;
            }
        }
        let before = information;
        if !settled {
            information = congruence(&kept, &information);
            information[0][0] += 1.0 / variance;
        }
        let here = i * n_columns..(i + 1) * n_columns;
        let (states, innovations) = (&trail.states[here.clone()], &trail.innovations[here.clone()]);
        for (c, (adjoint, out)) in adjoints.iter_mut().zip(&mut smoothed[here]).enumerate() {
            *adjoint = apply_transposed(&kept, adjoint);
            adjoint[0] -= innovations[c] / variance;
            let pulled = apply(root, &apply_transposed(root, adjoint));
            *out = places.map(|k| states[c][k] - pulled[k]);
        }
        variances[i] = if settled {
            variances[i + 1]
        } else {
            places.map(|k| state_variance(root, &information, k))
        };
        if i > 0 {
            let step = trail.steps.at(i);
            for adjoint in &mut adjoints {
                *adjoint = apply_transposed(&step.f, adjoint);
            }
            if !settled {
                information = congruence(&step.f, &information);
                settled = again && same(&before, &information);
            }
        }
    }
    Smoothed { columns: smoothed, n_columns, variances }
}

/// Variance of component `k` with the columns' weights known: `P - P J P`.
fn state_variance<const N: usize>(root: &Matrix<N>, information: &Matrix<N>, k: usize) -> f64 {
    // P = L L', so column k of P is L l with l row k of L.
    let row = root[k];
    let carried = apply(root, &row);
    let seen = apply(information, &carried);
    let seen: f64 = carried.iter().zip(&seen).map(|(a, b)| a * b).sum();
    (row.iter().map(|v| v * v).sum::<f64>() - seen).max(0.0)
}
