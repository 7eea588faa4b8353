//! What a model leaves, held against the noise of each channel: how much, how sure, and where.
//!
//! The noise is known from frequencies well above any roll; structure that the model lacks lives
//! at those of the roll. Three tests are made, for none sees everything: the power of the roll's
//! band as a whole, the strongest single frequency in it, and the strongest single period in time.

use super::survey::{Fit, Survey};
use crate::diagnosis::record::observation::Observation;
use crate::diagnosis::record::spectrum::powers;

/// What is left of one channel of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Leftover {
    /// Id of the run.
    pub run: String,
    /// `roll` or `moment`.
    pub channel: &'static str,
    /// Root mean square of what is left, in the channel's unit.
    pub rms: f64,
    /// Root mean square of what the channel reads about its mean, in its unit.
    pub motion_rms: f64,
    /// Power of the roll's band above the noise, as a share of the channel's variance [-].
    pub share: f64,
    /// The share that an error of the clock leaves of any roll [-].
    pub clock_share: f64,
    /// Standard deviations by which the power of the roll's band exceeds the noise [-].
    pub band_z: f64,
    /// The same of the strongest single frequency, as the logarithm of its odds.
    pub line_log_odds: f64,
    /// That frequency [rad/s].
    pub frequency_rad_s: f64,
    /// Middle of the period in which most is left [s], on the recording's time base.
    pub time_s: f64,
    /// Roll amplitude then [rad].
    pub amplitude_rad: f64,
    /// Ljung-Box statistic of 20 lags of the record thinned tenfold, in standard deviations [-].
    pub whiteness_z: f64,
    /// Excess of the misfit over the noise, in units of the noise's variance.
    pub excess: f64,
}

/// Standard deviations of the band above which structure is sure in one of many channels.
const SURE_BAND: f64 = 6.0;
/// The same for the logarithm of the odds of one frequency.
const SURE_LINE: f64 = 10.0;

/// Slow error of an instrument's clock that nobody has stated [s]: what is allowed behind an
/// adapter that delivers every 16 ms.
const CLOCK_S: f64 = 1e-3;

impl Leftover {
    /// Whether something is left for sure.
    pub(in crate::diagnosis) fn is_structure(&self) -> bool {
        self.band_z > SURE_BAND || self.line_log_odds > SURE_LINE
    }

    /// Whether something is left for sure that is no error of the clock.
    pub fn is_sure(&self) -> bool {
        self.is_structure() && self.share > self.clock_share
    }
}

/// What is left beyond the noise, in units of its variance.
pub(in crate::diagnosis) fn excess(all: &[Leftover]) -> f64 {
    all.iter().map(|l| l.excess).sum()
}

/// The same of the channels in which something is left for sure: noise alone adds up too.
pub(in crate::diagnosis) fn sure_excess(all: &[Leftover]) -> f64 {
    all.iter().filter(|l| l.is_structure()).map(|l| l.excess).sum()
}

/// Sum over channels of the shares that are left for sure [-]: what counts is how much of the
/// motion is not understood, however quiet the channel.
pub(in crate::diagnosis) fn sure_share(all: &[Leftover]) -> f64 {
    all.iter().filter(|l| l.is_structure()).map(|l| l.share).sum()
}

/// What a fit leaves of every channel of every run.
pub(in crate::diagnosis) fn leftovers(survey: &Survey, fit: &Fit) -> Vec<Leftover> {
    survey
        .each_run(&|run| of(&survey.runs[run], &survey.residual(fit, run)))
        .into_iter()
        .flatten()
        .collect()
}

/// The leftovers of a run, channel by channel.
fn of(run: &Observation, residual: &[f64]) -> Vec<Leftover> {
    let n_roll = run.roll_rad.len();
    let mut all = Vec::new();
    let channels = [
        ("roll", &residual[..n_roll], &run.roll_time_s, &run.roll_rad),
        ("moment", &residual[n_roll..], &run.moment_time_s, &run.moment_n_m),
    ];
    for ((channel, left, times, values), clock_s) in channels.into_iter().zip(run.clock_bounds_s) {
        if left.len() >= 64 {
            let clock_s = clock_s.unwrap_or(CLOCK_S);
            let leftover = channel_leftover(run, channel, left, times, values);
            let clock_share = (run.at.rolling_rad_s * clock_s).powi(2);
            all.push(Leftover { clock_share, ..leftover });
        }
    }
    all
}

fn channel_leftover(
    run: &Observation,
    channel: &'static str,
    left: &[f64],
    times: &[f64],
    values: &[f64],
) -> Leftover {
    let n = left.len();
    let step_s = (times[n - 1] - times[0]) / (n - 1) as f64;
    let w = run.at.rolling_rad_s.max(run.at.natural_rad_s);
    let bin_rad_s = std::f64::consts::TAU / (n as f64 * step_s);
    let band_end = ((4.0 * w / bin_rad_s) as usize).clamp(8, n / 3);
    let noise_from = ((6.0 * w / bin_rad_s) as usize).clamp(band_end + 1, n / 2 - 8);
    let angle = |bin: usize| std::f64::consts::TAU * bin as f64 / n as f64;
    let powers_at = |bins: &mut dyn Iterator<Item = usize>| -> Vec<f64> {
        let powers = powers(left, &bins.map(angle).collect::<Vec<_>>());
        powers.into_iter().map(|power| power / n as f64).collect()
    };
    let n_noise = n / 2 - noise_from;
    // A few hundred frequencies know the noise well enough.
    let stride = (n_noise / 300).max(1);
    let above = powers_at(&mut (noise_from..n / 2).step_by(stride));
    let mean_noise = median(&above) / std::f64::consts::LN_2;
    let band = powers_at(&mut (1..=band_end));
    let (n_band, n_above) = (band.len() as f64, above.len() as f64);
    let sum: f64 = band.iter().sum::<f64>() / mean_noise;
    // A median of n powers is known to 1/sqrt(n) of itself over ln 2.
    let sd = (n_band * (1.0 + 2.1 * n_band / n_above)).sqrt();
    let strongest = (0..band.len()).max_by(|a, b| band[*a].total_cmp(&band[*b])).unwrap_or(0);
    let line_log_odds = band[strongest] / mean_noise - n_band.ln();
    let middle = values.iter().sum::<f64>() / n as f64;
    let variance = values.iter().map(|v| (v - middle).powi(2)).sum::<f64>() / n as f64;
    let width = ((std::f64::consts::TAU / run.at.rolling_rad_s / step_s) as usize).clamp(4, n / 2);
    let energy = |start: usize| left[start..start + width].iter().map(|r| r * r).sum::<f64>();
    let start = (0..=n - width)
        .step_by((width / 4).max(1))
        .max_by(|a, b| energy(*a).total_cmp(&energy(*b)))
        .unwrap_or(0);
    let peak = |values: &[f64]| values.iter().map(|v| (v - middle).abs()).fold(0.0, f64::max);
    let rms = (left.iter().map(|r| r * r).sum::<f64>() / n as f64).sqrt();
    Leftover {
        run: run.id.clone(),
        channel,
        rms,
        motion_rms: variance.sqrt(),
        share: ((sum - n_band) * mean_noise / n as f64 * 2.0 / variance.max(1e-30)).max(0.0),
        clock_share: 0.0,
        band_z: (sum - n_band) / sd,
        line_log_odds,
        frequency_rad_s: (strongest + 1) as f64 * bin_rad_s,
        time_s: run.origin_s + times[start + width / 2],
        amplitude_rad: if channel == "roll" {
            peak(&values[start..start + width])
        } else {
            run.at.amplitude_rad
        },
        whiteness_z: whiteness_z(left),
        excess: 2.0 * (sum - n_band).max(0.0),
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Ljung-Box over 20 lags of means of ten, as standard deviations above its mean under white noise.
fn whiteness_z(left: &[f64]) -> f64 {
    const LAGS: usize = 20;
    let thin: Vec<f64> = left.chunks_exact(10).map(|c| c.iter().sum::<f64>() / 10.0).collect();
    let n = thin.len();
    if n < 3 * LAGS {
        return 0.0;
    }
    let power: f64 = thin.iter().map(|v| v * v).sum();
    let statistic: f64 = (1..=LAGS)
        .map(|lag| {
            let product: f64 = thin.iter().zip(&thin[lag..]).map(|(a, b)| a * b).sum();
            (product / power).powi(2) / (n - lag) as f64
        })
        .sum::<f64>()
        * (n * (n + 2)) as f64;
    (statistic - LAGS as f64) / (2.0 * LAGS as f64).sqrt()
}
