//! A run's roll record made ready for the inverse: from its first sample, evenly thinned.

use super::identification::Resimulation;
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
        let width = ((rate_hz / wanted_hz) as usize).max(1);
        let (time_s, roll_rad) = averaged(roll, width);
        let origin_s = time_s[0];
        let time_s = evened(time_s.iter().map(|t| t - origin_s).collect());
        if time_s.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err("the time stamps of the roll record do not rise".into());
        }
        Ok(Self { origin_s, time_s, roll_rad, rough_frequency_rad_s })
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
        let width = self.time_s.len().div_ceil(n_max);
        let series = Series { time_s: self.time_s.clone(), value: self.roll_rad.clone() };
        let (time_s, roll_rad) = averaged(&series, width);
        let first_s = time_s[0];
        let time_s = evened(time_s.iter().map(|t| t - first_s).collect());
        Self { origin_s: self.origin_s + first_s, time_s, roll_rad, ..*self }
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

/// Means over `width` samples, never across a hole in the record.
fn averaged(series: &Series, width: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut time_s, mut value) = (Vec::new(), Vec::new());
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
            time_s.push(series.time_s[start..end].iter().sum::<f64>() / count);
            value.push(series.value[start..end].iter().sum::<f64>() / count);
        }
        start = end;
    }
    (time_s, value)
}

/// Times on an even grid when they stray from one by less than the model could notice.
fn evened(time_s: Vec<f64>) -> Vec<f64> {
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
    let mut sorted = roll.value.clone();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted[sorted.len() / 2];
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
            Ok(std::f64::consts::PI * (crossings.len() - 1) as f64 / (last - first))
        }
        _ => Err(format!(
            "the roll crosses its mean {} times above a tenth of its range, 3 half cycles are \
             needed",
            crossings.len()
        )),
    }
}
