//! Damping coefficients of a decay: the equation of rolling fitted to the record.
//!
//! The law of Sec. 4.1 projected on `U` through the likelihood is the law fitted to the roll,
//! so that 500 correlated moments are not counted as 500 observations. Where the law leaves nothing
//! but noise, the posterior is that of least squares. Where it leaves more, which the evidence of a
//! walking moment (2.10) beside the law tells, the covariance is that of least squares under the
//! residual's own correlation (Newey and West, Econometrica 55, 1987), and so is wider.

use statrs::function::gamma::ln_gamma;

use crate::inverse::mixture::Component;
use crate::inverse::record::Record;
use crate::inverse::state_space::filter::{Column, Filtered, filter};
use crate::inverse::state_space::smoother::explained_by;
use crate::inverse::state_space::transition::IntegratedWiener;
use crate::roll::equation::{Decay, N_PARAMETERS, Sensitive};

/// Unknowns of a fit: those of [`Decay`], then the zero offset of the roll channel.
pub const N_UNKNOWNS: usize = N_PARAMETERS + 1;

/// Position of the linear damping among the unknowns.
pub const B1: usize = 3;
/// Position of the cubic damping among the unknowns.
pub const B3: usize = 4;
/// Position of the cubic restoring among the unknowns.
pub const K3: usize = 5;
/// Position of the zero offset among the unknowns.
pub const OFFSET: usize = N_PARAMETERS;

/// Prior width of the cubic restoring [1/rad2]: wall-sided hulls reach +0.6, hulls that lose
/// stability -1.
const CUBIC_RESTORING_SD: f64 = 1.0;

/// Intensities of the walking moment that are weighed against none. The smallest changes no record
/// that a tank is long enough for; the largest leaves the law nothing to explain.
const WALKS: [f64; 8] = [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0];

/// One linearised posterior of the unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Posterior weight among all solutions.
    pub weight: f64,
    /// Values of the unknowns.
    pub mean: [f64; N_UNKNOWNS],
    /// Covariance of the unknowns.
    pub covariance: [[f64; N_UNKNOWNS]; N_UNKNOWNS],
    /// Standard deviation of the roll noise [rad].
    pub noise_sd_rad: f64,
    /// Whether the restoring has a cubic part.
    pub cubic_restoring: bool,
    /// Posterior probability that the law leaves more than noise.
    pub probability_of_misfit: f64,
    /// Residual of the roll [rad], sample by sample.
    pub residual_rad: Vec<f64>,
}

/// The posterior of the unknowns of a decay: a mixture over linear and cubic restoring.
#[derive(Debug, Clone, PartialEq)]
pub struct DecayPosterior {
    /// The solutions, of which the weights sum to one.
    pub solutions: Vec<Solution>,
    /// The least-squares decay with linear restoring, and its zero offset [rad].
    pub linear: (Decay, f64),
}

impl DecayPosterior {
    /// Components of the mixture of one linear combination of the unknowns.
    pub fn combination(&self, weights: &[f64; N_UNKNOWNS]) -> Vec<Component> {
        let dot = |a: &[f64; N_UNKNOWNS]| a.iter().zip(weights).map(|(a, w)| a * w).sum::<f64>();
        self.solutions
            .iter()
            .map(|s| Component {
                weight: s.weight,
                mean: dot(&s.mean),
                sd: s
                    .covariance
                    .iter()
                    .zip(weights)
                    .map(|(row, w)| w * dot(row))
                    .sum::<f64>()
                    .max(0.0)
                    .sqrt(),
            })
            .collect()
    }

    /// Components of the mixture of one unknown.
    pub fn unknown(&self, position: usize) -> Vec<Component> {
        let mut weights = [0.0; N_UNKNOWNS];
        weights[position] = 1.0;
        self.combination(&weights)
    }

    /// Posterior probability that the restoring has a cubic part.
    pub fn probability_of_cubic_restoring(&self) -> f64 {
        self.solutions.iter().filter(|s| s.cubic_restoring).map(|s| s.weight).sum()
    }
}

/// Fits a decay that starts near `start`, whose roll channel reads `offset_rad` [rad] at rest.
///
/// # Errors
/// The reason, as a sentence, when the fit does not settle.
pub fn fit(record: &Record, start: Decay, offset_rad: f64) -> Result<DecayPosterior, String> {
    let linear = Fit { record, cubic_restoring: false }.settle(start, offset_rad)?;
    let cubic = Fit { record, cubic_restoring: true }.settle(linear.0, linear.1)?;
    let mut solutions = vec![
        Fit { record, cubic_restoring: false }.solution(linear),
        Fit { record, cubic_restoring: true }.solution(cubic),
    ];
    let top = solutions.iter().map(|s| s.weight).fold(f64::NEG_INFINITY, f64::max);
    for solution in &mut solutions {
        solution.weight = (solution.weight - top).exp();
    }
    let total: f64 = solutions.iter().map(|s| s.weight).sum();
    for solution in &mut solutions {
        solution.weight /= total;
    }
    solutions.retain(|s| s.weight > 1e-9);
    Ok(DecayPosterior { solutions, linear })
}

struct Fit<'a> {
    record: &'a Record,
    cubic_restoring: bool,
}

impl Fit<'_> {
    /// Gauss-Newton steps until they are far below the noise.
    fn settle(&self, mut decay: Decay, mut offset_rad: f64) -> Result<(Decay, f64), String> {
        let mut step_share = 1.0;
        let mut last_residual = f64::INFINITY;
        let mut last = (decay, offset_rad);
        let mut last_step = [0.0; N_UNKNOWNS];
        for _ in 0..40 {
            let filtered = self.whiten(&self.columns(&decay, offset_rad), &decay, 0.0);
            let residual = filtered.triangle.at(self.n_active(), self.n_active()).abs();
            let total = self.misfit(&filtered);
            if !total.is_finite() || total > last_residual * (1.0 + 1e-9) {
                // Too far: go back half of the way.
                step_share *= 0.5;
                if step_share < 1e-4 {
                    return Err("the roll equation cannot be fitted to the record".into());
                }
                (decay, offset_rad) = moved(last, &last_step, step_share);
                continue;
            }
            last_residual = total;
            step_share = 1.0;
            last = (decay, offset_rad);
            last_step = self.step(&filtered);
            let gain = (total * total - residual * residual).max(0.0).sqrt();
            (decay, offset_rad) = moved(last, &last_step, 1.0);
            // A step worth a thousandth of a standard deviation of the noise changes nothing.
            if gain < 1e-3 * residual / (filtered.n_samples as f64).sqrt() {
                return Ok((decay, offset_rad));
            }
        }
        Ok(last)
    }

    fn n_active(&self) -> usize {
        if self.cubic_restoring { N_UNKNOWNS } else { N_UNKNOWNS - 1 }
    }

    /// Positions of the unknowns that this fit moves.
    fn active(&self) -> impl Iterator<Item = usize> {
        let cubic_restoring = self.cubic_restoring;
        (0..N_UNKNOWNS).filter(move |&p| cubic_restoring || p != K3)
    }

    /// The sensitivities of the active unknowns, then the residual.
    fn columns(&self, decay: &Decay, offset_rad: f64) -> Vec<Vec<f64>> {
        let motion = decay.solve(&self.record.time_s);
        let by_unknown = |p: usize| {
            motion.iter().map(|m| if p == OFFSET { 1.0 } else { m.by_parameter[p] }).collect()
        };
        let residual = |(roll, m): (&f64, &Sensitive)| roll - offset_rad - m.roll_rad;
        let roll = self.record.roll_rad.iter().zip(&motion);
        self.active().map(by_unknown).chain([roll.map(residual).collect()]).collect()
    }

    /// The columns whitened under a walking moment of this intensity.
    fn whiten(&self, columns: &[Vec<f64>], decay: &Decay, walk: f64) -> Filtered {
        let columns: Vec<Column<'_>> = columns.iter().map(|c| Column::Record(c)).collect();
        let prior = IntegratedWiener { intensity: walk, moment_noise: 0.0 };
        let tau = self.record.scaled_time(decay.natural_frequency_rad_s);
        let mut filtered = filter::<3>(&prior, &tau, &columns, None);
        if self.cubic_restoring {
            self.add_prior(&mut filtered, decay);
        }
        filtered
    }

    /// The prior of the cubic restoring, as one more row in units of the noise.
    fn add_prior(&self, filtered: &mut Filtered, decay: &Decay) {
        let n = self.n_active();
        let noise = filtered.triangle.at(n, n).abs() / (filtered.n_samples as f64).sqrt();
        let mut row = vec![0.0; n + 1];
        row[K3] = noise / CUBIC_RESTORING_SD;
        row[n] = -noise / CUBIC_RESTORING_SD * decay.restoring_cubic_per_rad2;
        filtered.triangle.add(&mut row);
    }

    /// Norm of the whitened residual before the step.
    fn misfit(&self, filtered: &Filtered) -> f64 {
        let n = self.n_active();
        (0..=n).map(|i| filtered.triangle.at(i, n).powi(2)).sum::<f64>().sqrt()
    }

    fn step(&self, filtered: &Filtered) -> [f64; N_UNKNOWNS] {
        let weights = explained_by(&filtered.triangle, self.n_active(), self.n_active());
        let mut step = [0.0; N_UNKNOWNS];
        for (position, weight) in self.active().zip(weights) {
            step[position] = -weight;
        }
        step
    }

    /// The posterior linearised at the least-squares point; its weight is a logarithm.
    fn solution(&self, point: (Decay, f64)) -> Solution {
        let n = self.n_active();
        let mut columns = self.columns(&point.0, point.1);
        let lawful = self.whiten(&columns, &point.0, 0.0);
        let weight = self.log_evidence(&lawful);
        let walking: f64 = WALKS
            .iter()
            .map(|&walk| (self.log_evidence(&self.whiten(&columns, &point.0, walk)) - weight).exp())
            .sum::<f64>()
            / WALKS.len() as f64;
        let probability_of_misfit = 1.0 - 1.0 / (1.0 + walking);
        let noise_variance = lawful.triangle.at(n, n).powi(2) / (lawful.n_samples - n) as f64;
        let residual_rad = columns.pop().expect("the residual is the last column");
        let inverse = lawful.triangle.inverse_columns(n);
        let mut covariance = [[0.0; N_UNKNOWNS]; N_UNKNOWNS];
        let scores = if probability_of_misfit > 0.5 {
            correlated_scores(&columns, &residual_rad)
        } else {
            Vec::new()
        };
        let positions: Vec<usize> = self.active().collect();
        // (R'R)^-1 s^2 where the residual is noise; where it is not, (R'R)^-1 S (R'R)^-1 on top,
        // because S is itself estimated from few independent stretches and may come out small.
        let bread = sum_of_squares(&inverse);
        for (i, &p) in positions.iter().enumerate() {
            for (j, &q) in positions.iter().enumerate() {
                let white = noise_variance * bread[i][j];
                let correlated: f64 = scores
                    .iter()
                    .enumerate()
                    .map(|(k, row)| {
                        let inner: f64 = row.iter().zip(&bread).map(|(s, b)| s * b[j]).sum();
                        bread[i][k] * inner
                    })
                    .sum();
                covariance[p][q] = white + correlated;
            }
        }
        let mut mean = [0.0; N_UNKNOWNS];
        mean[..N_PARAMETERS].copy_from_slice(&point.0.parameters());
        mean[OFFSET] = point.1;
        Solution {
            weight,
            mean,
            covariance,
            noise_sd_rad: noise_variance.sqrt(),
            cubic_restoring: self.cubic_restoring,
            probability_of_misfit,
            residual_rad,
        }
    }

    /// Logarithm of the evidence, the noise integrated over a scale-free prior.
    fn log_evidence(&self, filtered: &Filtered) -> f64 {
        let n = self.n_active();
        let shape = 0.5 * (filtered.n_samples - n) as f64;
        let log_flat: f64 = (0..n).map(|i| filtered.triangle.at(i, i).abs().ln()).sum();
        let prior = if self.cubic_restoring { -CUBIC_RESTORING_SD.ln() } else { 0.0 };
        ln_gamma(shape)
            - shape * (0.5 * filtered.triangle.at(n, n).powi(2)).ln()
            - 0.5 * filtered.log_determinant
            - log_flat
            + prior
    }
}

/// The sum of `c c'` over the columns.
fn sum_of_squares(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = columns.len();
    let entry = |i: usize, j: usize| columns.iter().map(|c| c[i] * c[j]).sum();
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// The covariance of the scores `J_t r_t` with what correlation between samples adds, by Bartlett's
/// weights up to the lag that the scores' own persistence asks for (Andrews, Econometrica 59,
/// 1991).
fn correlated_scores(columns: &[Vec<f64>], residual_rad: &[f64]) -> Vec<Vec<f64>> {
    // Sums over a few samples carry the correlation at a fraction of the cost.
    let width = (residual_rad.len() / 1000).max(1);
    let scores: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| {
            let score = |(j, r): (&[f64], &[f64])| j.iter().zip(r).map(|(j, r)| j * r).sum();
            column.chunks(width).zip(residual_rad.chunks(width)).map(score).collect()
        })
        .collect();
    let lagged = |a: &[f64], b: &[f64], lag: usize| -> f64 {
        a[lag..].iter().zip(b).map(|(a, b)| a * b).sum()
    };
    let (mut above, mut below) = (0.0, 0.0);
    for score in &scores {
        let persistence = (lagged(score, score, 1) / lagged(score, score, 0)).clamp(0.0, 0.999);
        above += persistence.powi(2) / (1.0 - persistence).powi(6) / (1.0 + persistence).powi(2);
        below += 1.0 / (1.0 - persistence).powi(4);
    }
    let n = scores[0].len();
    let bandwidth = 1.1447 * (4.0 * above / below * n as f64).cbrt();
    let last = (bandwidth as usize).min(n / 4);
    let mut sum = vec![vec![0.0; scores.len()]; scores.len()];
    for lag in 0..=last {
        let share = if lag == 0 { 0.5 } else { 1.0 };
        let weight = share * (1.0 - lag as f64 / (last + 1) as f64);
        for (i, a) in scores.iter().enumerate() {
            for (j, b) in scores.iter().enumerate() {
                let ahead = weight * lagged(a, b, lag);
                sum[i][j] += ahead;
                sum[j][i] += ahead;
            }
        }
    }
    sum
}

fn moved(from: (Decay, f64), step: &[f64; N_UNKNOWNS], share: f64) -> (Decay, f64) {
    let mut values = from.0.parameters();
    for (value, step) in values.iter_mut().zip(step) {
        *value += share * step;
    }
    (Decay::from_parameters(values), from.1 + share * step[OFFSET])
}
