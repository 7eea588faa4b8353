//! One form of the law under one disturbance: coefficients, noise and evidence in closed form.

use statrs::function::gamma::ln_gamma;

use super::fit::{CUBIC_RESTORING, CUBIC_RESTORING_SD, CURVE, N_UNKNOWNS};
use super::form::{Direction, FORMS};
use crate::inverse::state_space::filter::Filtered;
use crate::inverse::state_space::triangle::Triangle;

/// A conjugate posterior of the unknowns: normal given the noise, the noise inverse gamma.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Means of the unknowns; damping curve and cubic restoring as a whole, the rest as changes.
    pub mean: [f64; N_UNKNOWNS],
    /// Root of the covariance in units of the noise variance: the sum of `f f'` over its columns.
    pub factor: Vec<[f64; N_UNKNOWNS]>,
    /// Coefficients of the form's directions, and the same root for them.
    pub coefficients: Vec<f64>,
    /// Columns of the root of the coefficients' covariance, in units of the noise variance.
    pub coefficient_factor: Vec<Vec<f64>>,
    /// Shape of the inverse gamma posterior of the noise variance.
    pub shape: f64,
    /// Its scale [rad2].
    pub scale_rad2: f64,
}

impl Solution {
    /// Posterior mean of the noise variance [rad2].
    pub fn noise_variance_rad2(&self) -> f64 {
        self.scale_rad2 / (self.shape - 1.0)
    }

    /// Mean and standard deviation of a linear combination of the unknowns.
    pub fn combination(&self, weights: &[f64; N_UNKNOWNS]) -> (f64, f64) {
        let dot = |x: &[f64; N_UNKNOWNS]| x.iter().zip(weights).map(|(x, w)| x * w).sum::<f64>();
        let square: f64 = self.factor.iter().map(|column| dot(column).powi(2)).sum();
        (dot(&self.mean), (square * self.noise_variance_rad2()).sqrt())
    }
}

/// One form of the law with one restoring, ready to be solved for.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Position of the form.
    pub form: usize,
    /// Whether the restoring has a cubic part.
    pub cubic_restoring: bool,
    units: Vec<Unit>,
    n_directions: usize,
    /// What turns priors into rows in units of the noise [rad].
    noise_rad: f64,
    /// Noise variance that the channel's own quantum makes [rad2].
    floor_rad2: f64,
}

impl Plan {
    /// The plan of a form at a noise of about `noise_rad` [rad], at least `floor_rad2` [rad2].
    pub fn new(form: usize, cubic_restoring: bool, noise_rad: f64, floor_rad2: f64) -> Self {
        let directions = FORMS[form].directions();
        let mut units: Vec<Unit> = (0..CURVE)
            .filter(|u| cubic_restoring || *u != CUBIC_RESTORING)
            .map(|u| Unit::unknown(u, (u == CUBIC_RESTORING).then_some(CUBIC_RESTORING_SD)))
            .collect();
        units.extend(directions.iter().map(Unit::direction));
        let n_directions = directions.len();
        Self { form, cubic_restoring, units, n_directions, noise_rad, floor_rad2 }
    }

    /// Logarithm of the evidence, up to a constant common to all plans of one record.
    pub fn log_evidence(&self, filtered: &Filtered) -> f64 {
        let triangle = self.triangle(filtered);
        let (shape, scale_rad2) = self.noise(filtered, &triangle);
        let priors: f64 =
            self.units.iter().filter_map(|u| u.prior_sd).map(|sd| (self.noise_rad / sd).ln()).sum();
        let log_flat: f64 = (0..self.units.len()).map(|i| triangle.at(i, i).abs().ln()).sum();
        ln_gamma(shape) - shape * scale_rad2.ln() - 0.5 * filtered.log_determinant - log_flat
            + priors
    }

    /// Everything about the unknowns.
    pub fn solution(&self, filtered: &Filtered) -> Solution {
        let triangle = self.triangle(filtered);
        let (shape, scale_rad2) = self.noise(filtered, &triangle);
        let n = self.units.len();
        let coefficients: Vec<f64> = triangle.explained_by(n, n).iter().map(|w| -w).collect();
        let inverse = triangle.inverse_columns(n);
        let first = n - self.n_directions;
        Solution {
            mean: self.spread(&coefficients),
            factor: inverse.iter().map(|column| self.spread(column)).collect(),
            coefficient_factor: inverse.iter().map(|column| column[first..].to_vec()).collect(),
            coefficients: coefficients[first..].to_vec(),
            shape,
            scale_rad2,
        }
    }

    /// Unknowns from their prior at a noise of `noise_sd_rad` [rad]; nil where it is flat.
    pub fn prior_draw(
        &self,
        noise_sd_rad: f64,
        mut normal: impl FnMut() -> f64,
    ) -> [f64; N_UNKNOWNS] {
        // The prior is conjugate: its width follows the noise.
        let share = noise_sd_rad / self.noise_rad;
        let values: Vec<f64> =
            self.units.iter().map(|u| u.prior_sd.map_or(0.0, |sd| share * sd * normal())).collect();
        self.spread(&values)
    }

    /// The whitened columns of this form, its priors added, reduced.
    fn triangle(&self, filtered: &Filtered) -> Triangle {
        let n = self.units.len();
        let mut triangle = Triangle::new(n + 1);
        let full = &filtered.triangle;
        for row in 0..=N_UNKNOWNS {
            let entry = |unit: &Unit| match unit.at {
                Some(unknown) if unknown < row => 0.0,
                Some(unknown) => full.at(row, unknown),
                None => (row.max(CURVE)..N_UNKNOWNS)
                    .map(|u| full.at(row, u) * unit.unknowns[u])
                    .sum::<f64>(),
            };
            triangle.push(self.units.iter().map(entry).chain([full.at(row, N_UNKNOWNS)]));
        }
        for (i, sd) in self.units.iter().enumerate().filter_map(|(i, u)| Some((i, u.prior_sd?))) {
            // A prior is one more row; it is worth what a normal density with its width is.
            triangle.push((0..=n).map(|j| if i == j { self.noise_rad / sd } else { 0.0 }));
        }
        triangle.settle();
        triangle
    }

    /// Shape and scale [rad2] of the inverse gamma posterior of the noise variance.
    fn noise(&self, filtered: &Filtered, triangle: &Triangle) -> (f64, f64) {
        let n_flat = self.units.iter().filter(|unit| unit.prior_sd.is_none()).count();
        let shape = 0.5 * (filtered.n_samples - n_flat) as f64;
        let n = self.units.len();
        // A noise below the quantum's own is impossible; the floor takes its place.
        let scale_rad2 = 0.5 * triangle.at(n, n).powi(2);
        (shape, scale_rad2.max(self.floor_rad2 * (shape - 1.0)))
    }

    fn spread(&self, values: &[f64]) -> [f64; N_UNKNOWNS] {
        let mut unknowns = [0.0; N_UNKNOWNS];
        for (value, unit) in values.iter().zip(&self.units) {
            for (out, u) in unknowns.iter_mut().zip(&unit.unknowns) {
                *out += value * u;
            }
        }
        unknowns
    }
}

/// One unknown of a form, as a combination of the columns.
#[derive(Debug, Clone)]
struct Unit {
    /// The column, where it is one.
    at: Option<usize>,
    unknowns: [f64; N_UNKNOWNS],
    prior_sd: Option<f64>,
}

impl Unit {
    fn unknown(position: usize, prior_sd: Option<f64>) -> Self {
        let mut unknowns = [0.0; N_UNKNOWNS];
        unknowns[position] = 1.0;
        Self { at: Some(position), unknowns, prior_sd }
    }

    fn direction(direction: &Direction) -> Self {
        let mut unknowns = [0.0; N_UNKNOWNS];
        unknowns[CURVE..].copy_from_slice(&direction.curve);
        Self { at: None, unknowns, prior_sd: Some(direction.prior_sd) }
    }
}
