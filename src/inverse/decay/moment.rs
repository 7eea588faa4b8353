//! The motion of a decay and the moment `U` behind it, with their bands.

use super::disturbance::{Disturbance, Misfit};
use super::fit::N_UNKNOWNS;
use super::posterior::DecayPosterior;
use crate::inverse::state_space::smoother::Smoothed;

/// Roll [rad] about its zero, roll rate [rad/s] and `U = phi'' + w^2 phi` [rad/s2].
#[derive(Debug, Clone, PartialEq)]
pub struct MotionPosterior {
    /// Means, sample by sample.
    pub mean: Vec<[f64; 3]>,
    /// Standard deviations, sample by sample.
    pub sd: Vec<[f64; 3]>,
}

/// All solutions under one disturbance, their first two moments kept.
struct Merged {
    weight: f64,
    mean: [f64; N_UNKNOWNS],
    /// Columns of a root of the covariance.
    root: Vec<[f64; N_UNKNOWNS]>,
    noise_variance_rad2: f64,
}

/// The motion and the moment of a decay.
pub fn motion(posterior: &DecayPosterior) -> MotionPosterior {
    let n_samples = posterior.linearised.motion.len();
    // Moments of what is added to the fit, so that no digits are lost.
    let mut mean = vec![[0.0; 3]; n_samples];
    let mut square = vec![[0.0; 3]; n_samples];
    for (disturbance, merged) in groups(posterior) {
        let smoothed = disturbance.misfit.and_then(|_| posterior.columns.smooth(&disturbance).1);
        let misfit = disturbance.misfit.zip(smoothed);
        for sample in 0..n_samples {
            for (k, row) in rows(posterior, misfit.as_ref(), sample).iter().enumerate() {
                let value: f64 = row.known
                    + row.weights.iter().zip(&merged.mean).map(|(w, m)| w * m).sum::<f64>();
                let spread = merged.noise_variance_rad2 * row.variance
                    + quadratic(&merged.root, &row.weights);
                mean[sample][k] += merged.weight * value;
                square[sample][k] += merged.weight * (spread + value * value);
            }
        }
    }
    let sd = mean
        .iter()
        .zip(&square)
        .map(|(m, s)| std::array::from_fn(|k| (s[k] - m[k] * m[k]).max(0.0).sqrt()))
        .collect();
    for (sample, mean) in mean.iter_mut().enumerate() {
        for (mean, base) in mean.iter_mut().zip(base(posterior, sample)) {
            *mean += base;
        }
    }
    MotionPosterior { mean, sd }
}

/// How one component of the motion at one sample depends on the unknowns.
struct Row {
    weights: [f64; N_UNKNOWNS],
    known: f64,
    /// Variance with the unknowns known, in units of the noise variance.
    variance: f64,
}

/// Roll, rate and moment of the fit itself.
fn base(posterior: &DecayPosterior, sample: usize) -> [f64; 3] {
    let linearised = &posterior.linearised;
    let motion = &linearised.motion[sample];
    [motion.roll_rad, motion.roll_rate_rad_per_s, linearised.moment_per_s2(sample)]
}

/// What the unknowns and the misfit add to the fit at one sample.
fn rows(
    posterior: &DecayPosterior,
    misfit: Option<&(Misfit, Smoothed)>,
    sample: usize,
) -> [Row; 3] {
    let linearised = &posterior.linearised;
    let w = linearised.point.decay.natural_frequency_rad_s;
    let mut rows: [Row; 3] =
        std::array::from_fn(|_| Row { weights: [0.0; N_UNKNOWNS], known: 0.0, variance: 0.0 });
    for unknown in 0..N_UNKNOWNS {
        let response = &linearised.responses[unknown][sample];
        let moment = linearised.moment_response(unknown, sample);
        for (row, value) in rows.iter_mut().zip([response.roll, response.rate, moment]) {
            row.weights[unknown] = value;
        }
    }
    // Damping and cubic restoring are sought as a whole; the fit's own share of them is known.
    for row in &mut rows {
        let whole = linearised.fitted.iter().zip(&row.weights);
        row.known = -whole.map(|(fitted, weight)| fitted * weight).sum::<f64>();
    }
    if let Some((misfit, smoothed)) = misfit {
        let size = posterior.columns.size(misfit, sample);
        let units = [1.0, w, w * w * size];
        let (record, columns) = smoothed.at(sample).split_last().expect("the record is the last");
        for (k, (row, unit)) in rows.iter_mut().zip(units).enumerate() {
            row.known += unit * record[k];
            row.variance = unit * unit * smoothed.variances[sample][k];
            for (weight, column) in row.weights.iter_mut().zip(columns) {
                *weight -= unit * column[k];
            }
        }
    }
    rows
}

/// A solution lighter than this share of the heaviest moves no end of a 95 % band by much, while
/// its variance would move both: bands are those of the solutions above it.
const LIGHT: f64 = 0.05;

/// The solutions of each disturbance merged; those without a misfit share one smoothing.
fn groups(posterior: &DecayPosterior) -> Vec<(Disturbance, Merged)> {
    let mut groups: Vec<(Disturbance, Vec<usize>)> = Vec::new();
    let least = posterior.solutions[0].log_weight + LIGHT.ln();
    let heavy = posterior.solutions.iter().take_while(|weighed| weighed.log_weight >= least);
    let mut total = 0.0;
    for (i, weighed) in heavy.enumerate() {
        total += weighed.weight();
        let disturbance = posterior.disturbances[weighed.disturbance];
        let same = |d: &Disturbance| {
            *d == disturbance || (d.misfit.is_none() && disturbance.misfit.is_none())
        };
        match groups.iter_mut().find(|(d, _)| same(d)) {
            Some((_, members)) => members.push(i),
            None => groups.push((disturbance, vec![i])),
        }
    }
    groups.into_iter().map(|(d, members)| (d, merged(posterior, &members, total))).collect()
}

fn merged(posterior: &DecayPosterior, members: &[usize], total: f64) -> Merged {
    let of = |i: &usize| &posterior.solutions[*i];
    let weight: f64 = members.iter().map(|i| of(i).weight()).sum();
    let share = |i: &usize| of(i).weight() / weight.max(f64::MIN_POSITIVE);
    let mut mean = [0.0; N_UNKNOWNS];
    let mut noise_variance_rad2 = 0.0;
    for i in members {
        let solution = &of(i).solution;
        noise_variance_rad2 += share(i) * solution.noise_variance_rad2();
        for (mean, value) in mean.iter_mut().zip(solution.mean) {
            *mean += share(i) * value;
        }
    }
    let mut covariance = [[0.0; N_UNKNOWNS]; N_UNKNOWNS];
    let mut add = |vector: &[f64; N_UNKNOWNS], share: f64| {
        for (row, x) in covariance.iter_mut().zip(vector) {
            for (entry, y) in row.iter_mut().zip(vector) {
                *entry += share * x * y;
            }
        }
    };
    for i in members {
        let solution = &of(i).solution;
        let variance = solution.noise_variance_rad2();
        for column in &solution.factor {
            add(column, share(i) * variance);
        }
        add(&std::array::from_fn(|u| solution.mean[u] - mean[u]), share(i));
    }
    Merged { weight: weight / total, mean, root: root(&covariance), noise_variance_rad2 }
}

/// The columns of the triangular root of a covariance; a direction that is known has none.
fn root(covariance: &[[f64; N_UNKNOWNS]; N_UNKNOWNS]) -> Vec<[f64; N_UNKNOWNS]> {
    let mut left = *covariance;
    let mut columns = Vec::with_capacity(N_UNKNOWNS);
    for j in 0..N_UNKNOWNS {
        // What is left of a variance after rounding says nothing.
        if left[j][j] <= 1e-13 * covariance[j][j] {
            continue;
        }
        let scale = left[j][j].sqrt().recip();
        let mut column = [0.0; N_UNKNOWNS];
        for (out, row) in column[j..].iter_mut().zip(&left[j..]) {
            *out = row[j] * scale;
        }
        for (row, x) in left.iter_mut().zip(column) {
            for (entry, y) in row.iter_mut().zip(column) {
                *entry -= x * y;
            }
        }
        columns.push(column);
    }
    columns
}

fn quadratic(root: &[[f64; N_UNKNOWNS]], weights: &[f64; N_UNKNOWNS]) -> f64 {
    let share = |column: &[f64; N_UNKNOWNS]| -> f64 {
        column.iter().zip(weights).map(|(c, w)| c * w).sum()
    };
    root.iter().map(|column| share(column).powi(2)).sum()
}
