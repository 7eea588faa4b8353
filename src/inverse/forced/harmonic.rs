//! A periodic record as a Fourier series whose frequency is unknown too.

use crate::inverse::estimate::Estimate;
use crate::inverse::state_space::triangle::Triangle;

/// Harmonics that are kept: the fundamental, and what asymmetry and a cubic law add.
const N_HARMONICS: usize = 3;
const N_COEFFICIENTS: usize = 2 * N_HARMONICS + 1;

/// `x = c0 + sum_h a_h cos(h w t) + b_h sin(h w t)` with its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FourierSeries {
    /// Fundamental frequency `w` [rad/s].
    pub frequency_rad_s: Estimate,
    /// Mean `c0`.
    pub mean: f64,
    /// Pairs `(a_h, b_h)`, fundamental first.
    pub pairs: [(f64, f64); N_HARMONICS],
    /// Standard deviation of every `a_h` and `b_h`.
    pub coefficient_sd: f64,
    /// Standard deviation of the noise of one sample.
    pub noise_sd: f64,
}

/// A value with its first two derivatives in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Value.
    pub value: f64,
    /// First derivative [1/s].
    pub rate: f64,
    /// Second derivative [1/s2].
    pub acceleration: f64,
}

impl FourierSeries {
    /// Fits the series by least squares, the frequency starting from `near_rad_s` [rad/s].
    ///
    /// # Errors
    /// The reason, as a sentence, when the record is not periodic near that frequency.
    pub fn fit(time_s: &[f64], value: &[f64], near_rad_s: f64) -> Result<Self, String> {
        let span_s = time_s[time_s.len() - 1] - time_s[0];
        let mut frequency = near_rad_s;
        for _ in 0..30 {
            let (coefficients, _) = linear_fit(time_s, value, frequency);
            let (step, sd, series) = refine(time_s, value, frequency, &coefficients);
            // Beyond a third of a cycle over the record the linearisation means nothing.
            let bound = 2.0 / span_s;
            frequency += step.clamp(-bound, bound);
            if !(0.5 * near_rad_s..2.0 * near_rad_s).contains(&frequency) {
                break;
            }
            // Without noise there is no deviation to compare with, and rounding ends the search.
            if step.abs() < (1e-3 * sd).max(1e-12 * frequency) {
                return Ok(Self { frequency_rad_s: Estimate::normal(frequency, sd), ..series });
            }
        }
        Err(format!("the record does not repeat at a frequency near {near_rad_s:.3} rad/s"))
    }

    /// Fits the series at a known frequency, such as that of another channel of the same run, so
    /// that the two can be compared in phase.
    pub fn fit_at(time_s: &[f64], value: &[f64], frequency_rad_s: Estimate) -> Self {
        let (coefficients, triangle) = linear_fit(time_s, value, frequency_rad_s.mean);
        let freedom = time_s.len() as f64 - N_COEFFICIENTS as f64;
        let noise_sd = triangle.at(N_COEFFICIENTS, N_COEFFICIENTS).abs() / freedom.sqrt();
        Self {
            frequency_rad_s,
            mean: coefficients[0],
            pairs: pairs(&coefficients),
            coefficient_sd: noise_sd * (2.0 / time_s.len() as f64).sqrt(),
            noise_sd,
        }
    }

    /// Amplitude of the fundamental.
    pub fn amplitude(&self) -> f64 {
        self.pairs[0].0.hypot(self.pairs[0].1)
    }

    /// Unit series of the same frequency, one for each cosine and sine coefficient.
    pub fn units(&self) -> Vec<Self> {
        let none = Self { mean: 0.0, pairs: [(0.0, 0.0); N_HARMONICS], ..*self };
        let mut units = vec![none; 2 * N_HARMONICS];
        for (h, pair) in units.chunks_exact_mut(2).enumerate() {
            pair[0].pairs[h].0 = 1.0;
            pair[1].pairs[h].1 = 1.0;
        }
        units
    }

    /// The series and its derivatives at `time_s` [s].
    pub fn at(&self, time_s: f64) -> Motion {
        let mut motion = Motion { value: self.mean, rate: 0.0, acceleration: 0.0 };
        for (harmonic, (a, b)) in (1..).zip(self.pairs) {
            let w = f64::from(harmonic) * self.frequency_rad_s.mean;
            let (sin, cos) = (w * time_s).sin_cos();
            motion.value += a * cos + b * sin;
            motion.rate += w * (b * cos - a * sin);
            motion.acceleration -= w * w * (a * cos + b * sin);
        }
        motion
    }
}

fn row(time_s: f64, frequency: f64) -> [f64; N_COEFFICIENTS] {
    let mut row = [1.0; N_COEFFICIENTS];
    for (harmonic, pair) in (1..).zip(row[1..].chunks_exact_mut(2)) {
        let (sin, cos) = (f64::from(harmonic) * frequency * time_s).sin_cos();
        pair[0] = cos;
        pair[1] = sin;
    }
    row
}

fn linear_fit(time_s: &[f64], value: &[f64], frequency: f64) -> (Vec<f64>, Triangle) {
    let mut triangle = Triangle::new(N_COEFFICIENTS + 1);
    for (&t, &v) in time_s.iter().zip(value) {
        let mut line = [0.0; N_COEFFICIENTS + 1];
        line[..N_COEFFICIENTS].copy_from_slice(&row(t, frequency));
        line[N_COEFFICIENTS] = v;
        triangle.push(line);
    }
    triangle.settle();
    let weights = triangle.explained_by(N_COEFFICIENTS, N_COEFFICIENTS);
    (weights.iter().map(|w| -w).collect(), triangle)
}

fn pairs(coefficients: &[f64]) -> [(f64, f64); N_HARMONICS] {
    std::array::from_fn(|h| (coefficients[1 + 2 * h], coefficients[2 + 2 * h]))
}

/// Step of the frequency, its standard deviation, and the series before the step.
fn refine(
    time_s: &[f64],
    value: &[f64],
    frequency: f64,
    coefficients: &[f64],
) -> (f64, f64, FourierSeries) {
    let mut series = FourierSeries {
        frequency_rad_s: Estimate::normal(frequency, 0.0),
        mean: coefficients[0],
        pairs: pairs(coefficients),
        coefficient_sd: 0.0,
        noise_sd: 0.0,
    };
    let n = N_COEFFICIENTS + 1;
    let mut triangle = Triangle::new(n + 1);
    for (&t, &v) in time_s.iter().zip(value) {
        let motion = series.at(t);
        let mut line = [0.0; N_COEFFICIENTS + 2];
        line[..N_COEFFICIENTS].copy_from_slice(&row(t, frequency));
        // A change of frequency stretches time: its derivative is the rate times t / w.
        line[n - 1] = motion.rate * t / frequency;
        line[n] = v - motion.value;
        triangle.push(line);
    }
    triangle.settle();
    let step = -triangle.explained_by(n, n)[n - 1];
    let freedom = time_s.len() as f64 - n as f64;
    series.noise_sd = triangle.at(n, n).abs() / freedom.sqrt();
    series.coefficient_sd = series.noise_sd * (2.0 / time_s.len() as f64).sqrt();
    (step, series.noise_sd / triangle.at(n - 1, n - 1).abs(), series)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clean_series_is_found_from_a_frequency_that_is_two_per_cent_off() {
        let time_s: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.01).collect();
        let value: Vec<f64> =
            time_s.iter().map(|t| 0.1 + 2.0 * (5.12 * t).cos() + 0.3 * (15.36 * t).sin()).collect();
        let series = FourierSeries::fit(&time_s, &value, 5.2).expect("it is periodic");
        assert!((series.frequency_rad_s.mean - 5.12).abs() < 1e-9);
        assert!((series.pairs[2].1 - 0.3).abs() < 1e-9 && (series.mean - 0.1).abs() < 1e-9);
    }
}
