//! What a record shows without any model: its noise, its steps, lines in it.

use super::clipping;
use super::noise::fourth_differences;
use super::spectrum;
use crate::model::{Facts, Line};
use crate::run::Series;

/// Facts of a roll record as recorded, and of what was read before it.
pub(super) fn of(
    before: &Series,
    roll: &Series,
    quantum_rad: Option<f64>,
    rolling_rad_s: f64,
    froude: f64,
) -> Facts {
    let n = roll.time_s.len();
    let sample_rate_hz = (n - 1) as f64 / (roll.time_s[n - 1] - roll.time_s[0]);
    let lowest_hz = (5.0 * rolling_rad_s / std::f64::consts::TAU).max(3.5);
    let line = line(&roll.value, sample_rate_hz, lowest_hz, rolling_rad_s / std::f64::consts::TAU);
    let line_band_hz = [lowest_hz, 0.5 * sample_rate_hz];
    let clip = clipping::clip(before, roll, rolling_rad_s);
    Facts { quantum_rad, line, line_band_hz, n_samples: n, sample_rate_hz, froude, clip }
}

/// Least logarithm of a Bayes factor over all runs at which what their records show is told.
pub(in crate::diagnosis) const SURE: f64 = 14.0;
/// Samples in which a line is sought; more say no more than that it is there.
const LONGEST: usize = 4096;
/// Least logarithm of a Bayes factor at which a line is worth telling.
const LEAST: f64 = 12.0;

/// The strongest line well above the roll's own harmonics.
fn line(values: &[f64], rate_hz: f64, lowest_hz: f64, rolling_hz: f64) -> Option<Line> {
    let differences = fourth_differences(&values[..values.len().min(LONGEST)]);
    let n = differences.len();
    if n < 64 {
        return None;
    }
    let first = (lowest_hz * n as f64 / rate_hz).ceil() as usize;
    // Less what fourth differences make of it.
    let seen = windowed_powers(&differences, first).into_iter();
    let powers: Vec<f64> = seen.map(|(power, a)| power / (2.0 * (0.5 * a).sin()).powi(8)).collect();
    // An odd multiple of the roll's frequency is the roll's own, bent by a channel or a force.
    let is_own = |bin: usize| {
        let hz = (first + bin) as f64 * rate_hz / n as f64;
        let order = (hz / rolling_hz).round() as usize;
        let off_hz = (hz - order as f64 * rolling_hz).abs();
        order <= 15 && !order.is_multiple_of(2) && off_hz < 2.0 * rate_hz / n as f64 + 0.01 * hz
    };
    stands_out(&powers, n, &|bin| !is_own(bin)).map(|line| line.at(first, rate_hz, n))
}

/// Powers of the values under Hann's window from a bin on, each with its angle per sample.
pub(super) fn windowed_powers(values: &[f64], first: usize) -> Vec<(f64, f64)> {
    let n = values.len();
    let windowed: Vec<f64> = values
        .iter()
        .enumerate()
        .map(|(i, v)| v * (std::f64::consts::PI * (i as f64 + 0.5) / n as f64).sin().powi(2))
        .collect();
    let angle = |bin: usize| std::f64::consts::TAU * bin as f64 / n as f64;
    let angles: Vec<f64> = (first..=n / 2).map(angle).collect();
    spectrum::powers(&windowed, &angles).into_iter().zip(angles).collect()
}

/// A line by its bin, before its frequency is told.
struct Standing {
    bin: usize,
    line: Line,
}

impl Standing {
    /// The line, where the first bin is `first` of `n` samples.
    fn at(self, first: usize, rate_hz: f64, n: usize) -> Line {
        let frequency_hz = (first + self.bin) as f64 * rate_hz / n as f64;
        Line { frequency_hz, ..self.line }
    }
}

/// The strongest of the powers of `n` samples that may be a line, where it stands out of all.
fn stands_out(powers: &[f64], n: usize, may_be: &dyn Fn(usize) -> bool) -> Option<Standing> {
    if powers.len() < 32 {
        return None;
    }
    let foreign = (0..powers.len()).filter(|bin| may_be(*bin));
    let best = foreign.max_by(|a, b| powers[*a].total_cmp(&powers[*b]))?;
    let mut sorted = powers.to_vec();
    let middle = sorted.len() / 2;
    let median = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mean = median / std::f64::consts::LN_2;
    let excess = powers[best] / mean;
    let log_bayes_factor = excess - (powers.len() as f64).ln() - 3.0;
    if log_bayes_factor < LEAST {
        return None;
    }
    // The Hann window passes half of an amplitude and 3/8 of a power.
    let noise_sd = (mean / (0.375 * n as f64)).sqrt();
    let amplitude_rad = 2.0 * (powers[best] / (0.25 * (n * n) as f64)).sqrt();
    let amplitude_sd_rad = noise_sd * (2.0 / n as f64).sqrt();
    let line = Line { frequency_hz: 0.0, amplitude_rad, amplitude_sd_rad, log_bayes_factor };
    Some(Standing { bin: best, line })
}
