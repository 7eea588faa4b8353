//! A run's roll record made ready for the inverse: from its first sample, evenly thinned.

use super::identification::Resimulation;
use super::quantum::quantum;
use crate::run::Series;

/// Roll against time from the start of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Instant of the first sample on the recording's time base [s].
    pub origin_s: f64,
    /// Times from the origin [s], strictly rising from zero.
    pub time_s: Vec<f64>,
    /// Roll as measured [rad], zero offset included.
    pub roll_rad: Vec<f64>,
    /// Rough frequency of the roll [rad/s], from its zero crossings.
    pub rough_frequency_rad_s: f64,
    /// Variance of the instants that each value is the mean of [s2].
    pub spread_s2: f64,
    /// Recorded samples that each value is the mean of.
    pub n_averaged: usize,
    /// Step between the values that the channel can take, where it is coarse enough to be seen
    /// [rad].
    pub quantum_rad: Option<f64>,
}

/// Samples per roll period that are kept: averaging over one sample's width then attenuates the
/// roll by less than 0.1 %, and the white noise that is averaged away is noise all the same.
const SAMPLES_PER_PERIOD: f64 = 80.0;

/// Share of the sample period by which stamps may stray before they are believed one by one.
const JITTER_SHARE: f64 = 0.02;

impl Record {
    /// Prepares a run's roll.
    ///
    /// # Errors
    /// The reason, as a sentence, why nothing can be identified from it.
    pub fn new(roll: &Series) -> Result<Self, String> {
        let n_samples = roll.time_s.len();
        if n_samples < 30 {
            return Err(format!("{n_samples} roll samples are too few, 30 are needed"));
        }
        if roll.value.iter().chain(&roll.time_s).any(|v| !v.is_finite()) {
            return Err("the roll record holds values that are not numbers".into());
        }
        let rough_frequency_rad_s = rough_frequency(roll)?;
        let span_s = roll.time_s[n_samples - 1] - roll.time_s[0];
        let rate_hz = (n_samples - 1) as f64 / span_s;
        let wanted_hz = SAMPLES_PER_PERIOD * rough_frequency_rad_s / std::f64::consts::TAU;
        let width = width(n_samples, ((rate_hz / wanted_hz) as usize).max(1));
        let Averaged { time_s, value: roll_rad, spread_s2 } = averaged(roll, width);
        if time_s.len() < 30 {
            return Err(format!(
                "{} stretches of {width} samples without a hole are too few, 30 are needed",
                time_s.len()
            ));
        }
        let origin_s = time_s[0];
        let time_s = evened(time_s.iter().map(|t| t - origin_s).collect());
        if time_s.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err("the time stamps of the roll record do not rise".into());
        }
        Ok(Self {
            origin_s,
            time_s,
            roll_rad,
            rough_frequency_rad_s,
            spread_s2,
            n_averaged: width,
            quantum_rad: quantum(&roll.value),
        })
    }

    /// Length [s].
    pub fn span_s(&self) -> f64 {
        self.time_s[self.time_s.len() - 1]
    }

    /// Size of the roll: root mean square about its mean [rad].
    pub fn scale_rad(&self) -> f64 {
        let n = self.roll_rad.len() as f64;
        let mean = self.roll_rad.iter().sum::<f64>() / n;
        (self.roll_rad.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / n).sqrt()
    }

    /// The record beside what a simulation makes of it [rad], zero offset included.
    pub(super) fn resimulation(&self, simulated_rad: Vec<f64>) -> Resimulation {
        let square: f64 =
            simulated_rad.iter().zip(&self.roll_rad).map(|(s, m)| (m - s).powi(2)).sum();
        Resimulation {
            time_s: self.time_s.iter().map(|t| self.origin_s + t).collect(),
            measured_rad: self.roll_rad.clone(),
            rmse_rad: (square / simulated_rad.len() as f64).sqrt(),
            simulated_rad,
        }
    }

    /// Whether all samples are one step apart.
    pub fn is_even(&self) -> bool {
        let step = self.time_s[1];
        self.time_s.iter().enumerate().all(|(i, &t)| t.to_bits() == (step * i as f64).to_bits())
    }

    /// The same record averaged to at most `n_max` samples.
    #[must_use]
    pub fn at_most(&self, n_max: usize) -> Self {
        self.averaged_by(self.time_s.len().div_ceil(n_max))
    }

    /// The same record averaged to about `wanted` samples per roll period, if it has more.
    #[must_use]
    pub fn per_period(&self, wanted: f64) -> Self {
        let wanted_hz = wanted * self.rough_frequency_rad_s / std::f64::consts::TAU;
        let rate_hz = (self.time_s.len() - 1) as f64 / self.span_s();
        // Thirty samples must be left of the shortest record.
        let most = (self.time_s.len() / 30).max(1);
        let widest = ((rate_hz / wanted_hz) as usize).clamp(1, most);
        self.averaged_by(width(self.time_s.len(), widest))
    }

    fn averaged_by(&self, width: usize) -> Self {
        if width < 2 {
            return self.clone();
        }
        let series = Series { time_s: self.time_s.clone(), value: self.roll_rad.clone() };
        let Averaged { time_s, value, spread_s2 } = averaged(&series, width);
        let first_s = time_s[0];
        let time_s = evened(time_s.iter().map(|t| t - first_s).collect());
        Self {
            origin_s: self.origin_s + first_s,
            time_s,
            roll_rad: value,
            spread_s2: self.spread_s2 + spread_s2,
            n_averaged: self.n_averaged * width,
            ..*self
        }
    }

    /// Times in units of `1/w` [-].
    pub fn scaled_time(&self, frequency_rad_s: f64) -> Vec<f64> {
        if self.is_even() {
            let step = self.time_s[1];
            // Rounding to a power of two makes the differences of multiples exact.
            let unit = (step * frequency_rad_s * 2.0_f64.powi(32)).round() / 2.0_f64.powi(32);
            (0..self.time_s.len()).map(|i| unit * i as f64).collect()
        } else {
            self.time_s.iter().map(|t| t * frequency_rad_s).collect()
        }
    }
}

/// The width of at most `widest` that leaves fewest of `n_samples` over at the end.
fn width(n_samples: usize, widest: usize) -> usize {
    let narrowest = (4 * widest).div_ceil(5);
    (narrowest..=widest).rev().min_by_key(|width| n_samples % width).unwrap_or(widest)
}

/// Means over equal counts of samples.
struct Averaged {
    time_s: Vec<f64>,
    value: Vec<f64>,
    /// Mean variance of the instants within a block [s2].
    spread_s2: f64,
}

/// Means over `width` samples, never across a hole in the record.
fn averaged(series: &Series, width: usize) -> Averaged {
    let (mut time_s, mut value, mut spread_s2) = (Vec::new(), Vec::new(), 0.0);
    let n = series.time_s.len();
    let period_s = (series.time_s[n - 1] - series.time_s[0]) / (n - 1) as f64;
    let mut start = 0;
    while start < n {
        let mut end = start + 1;
        while end < n
            && end - start < width
            && series.time_s[end] - series.time_s[end - 1] < 1.5 * period_s
        {
            end += 1;
        }
        // A block cut short by a hole or the end would weigh as much as a whole one.
        if end - start == width {
            let count = width as f64;
            let middle_s = series.time_s[start..end].iter().sum::<f64>() / count;
            let square = |t: &f64| (t - middle_s).powi(2);
            spread_s2 += series.time_s[start..end].iter().map(square).sum::<f64>() / count;
            time_s.push(middle_s);
            value.push(series.value[start..end].iter().sum::<f64>() / count);
        }
        start = end;
    }
    spread_s2 /= time_s.len().max(1) as f64;
    Averaged { time_s, value, spread_s2 }
}

/// Times on an even grid when they stray from one by less than the model could notice.
pub fn evened(time_s: Vec<f64>) -> Vec<f64> {
    let n = time_s.len();
    let step = time_s[n - 1] / (n - 1) as f64;
    let strays =
        time_s.iter().enumerate().any(|(i, t)| (t - step * i as f64).abs() > JITTER_SHARE * step);
    if strays { time_s } else { (0..n).map(|i| step * i as f64).collect() }
}

/// Frequency from the crossings of the middle level, with a dead band of a tenth of the range.
fn rough_frequency(roll: &Series) -> Result<f64, String> {
    let low = roll.value.iter().copied().fold(f64::INFINITY, f64::min);
    let high = roll.value.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut values = roll.value.clone();
    let half = values.len() / 2;
    let middle = *values.select_nth_unstable_by(half, f64::total_cmp).1;
    let band = 0.1 * (high - low);
    if band <= 0.0 {
        return Err(format!("the roll is constant at {:.3} deg", low.to_degrees()));
    }
    let mut side = 0.0;
    let mut crossings: Vec<f64> = Vec::new();
    let mut left_s = roll.time_s[0];
    for (&time_s, &value) in roll.time_s.iter().zip(&roll.value) {
        let above = value - middle;
        if above * side <= 0.0 && above.abs() < band {
            continue;
        }
        if above.abs() >= band {
            if side * above < 0.0 {
                crossings.push(0.5 * (left_s + time_s));
            }
            side = above.signum();
            left_s = time_s;
        } else if above * side > 0.0 {
            left_s = time_s;
        }
    }
    match crossings.as_slice() {
        [first, .., last] if last > first => {
            Ok(std::f64::consts::PI * half_cycles(&crossings) / (last - first))
        }
        _ => Err(format!(
            "the roll crosses its mean {} times above a tenth of its range, 3 half cycles are \
             needed",
            crossings.len()
        )),
    }
}

/// Half cycles from the first crossing to the last, those in a hole of the record included.
fn half_cycles(crossings: &[f64]) -> f64 {
    let mut spans: Vec<f64> = crossings.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let half = spans.len() / 2;
    let usual = *spans.select_nth_unstable_by(half, f64::total_cmp).1;
    crossings.windows(2).map(|pair| ((pair[1] - pair[0]) / usual).round().max(1.0)).sum()
}
