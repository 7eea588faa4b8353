//! A carriage that does not keep its speed, as its own record shows.

use std::f64::consts::{LN_2, TAU};

use super::facts::SURE;
use super::noise::rough_noise;
use super::spectrum;
use crate::diagnosis::cause::Cause;
use crate::inverse::estimate::Estimate;
use crate::inverse::forced::harmonic::FourierSeries;
use crate::model::UNDER_WAY_FROUDE;
use crate::run::Series;

/// The effect that it is an instance of.
pub(in crate::diagnosis) const EFFECT: &str = "tank.unsteady_speed";
const EQUATION: &str = "V (1 + dv exp(-t/T)) or V (1 + dv sin(2 pi f t + e)), as recorded";

/// Least share of the speed that is told [-]: damping follows its square at most, and runs repeat
/// to some hundredths of it. By judgement.
const LEAST: f64 = 0.01;
/// Times in which a speed may settle [s]; any is within a factor of `sqrt(2)` of one of these.
const SETTLES_S: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
/// Highest frequency at which a carriage may wobble [Hz].
const FASTEST_HZ: f64 = 2.0;
/// Least noise of a speed, as a share of it: what is read in coarse steps has none between them.
const LEAST_NOISE: f64 = 1e-4;
/// Samples below which a record says nothing.
const FEWEST: usize = 64;

/// How a carriage left its speed in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Wavering {
    /// Share of the speed [-].
    share: Estimate,
    /// Symbol and unit of the time in which it settles, or of the frequency of its wobble.
    course: (&'static str, &'static str, Estimate),
    /// Sum of squares of the share that this takes from the record [-].
    explained: f64,
    log_bayes_factor: f64,
}

impl Wavering {
    /// Looks at the speed [m/s] of a run at a Froude number [-]; none where it is kept, or was not
    /// recorded.
    pub(super) fn of(speed: &Series, froude: f64) -> Option<Self> {
        let n = speed.value.len();
        let mean_m_s = speed.value.iter().sum::<f64>() / n.max(1) as f64;
        if n < FEWEST || froude <= UNDER_WAY_FROUDE || mean_m_s.abs() < f64::MIN_POSITIVE {
            return None;
        }
        let off: Vec<f64> = speed.value.iter().map(|v| v / mean_m_s - 1.0).collect();
        let since: Vec<f64> = speed.time_s.iter().map(|t| t - speed.time_s[0]).collect();
        let noise = rough_noise(&off).max(LEAST_NOISE);
        let n_tried = (2.0 * FASTEST_HZ * since[n - 1]) as usize;
        let all = SETTLES_S.iter().map(|time_s| settling(&since, &off, noise, *time_s));
        let all = all.chain(wobbling(&since, &off, noise, n_tried));
        let best = all.max_by(|a, b| a.explained.total_cmp(&b.explained))?;
        let log_tried = ((SETTLES_S.len() + n_tried) as f64).ln();
        let log_bayes_factor = 0.5 * best.explained / noise.powi(2) - log_tried;
        let is_told = best.share.mean.abs() > LEAST && log_bayes_factor > SURE;
        is_told.then_some(Self { log_bayes_factor, ..best })
    }
}

/// The share of a speed that settles in a time [s], by least squares.
fn settling(since_s: &[f64], off: &[f64], noise: f64, time_s: f64) -> Wavering {
    let fades: Vec<f64> = since_s.iter().map(|t| (-t / time_s).exp()).collect();
    let mean = fades.iter().sum::<f64>() / fades.len() as f64;
    let size: f64 = fades.iter().map(|f| (f - mean).powi(2)).sum();
    let share = fades.iter().zip(off).map(|(f, off)| (f - mean) * off).sum::<f64>() / size;
    Wavering {
        share: Estimate::normal(share, noise / size.sqrt()),
        // As likely anywhere between the middles to the next times, which lie an octave off.
        course: ("T", "s", Estimate::normal(time_s, time_s * LN_2 / 12.0_f64.sqrt())),
        explained: share * share * size,
        log_bayes_factor: 0.0,
    }
}

/// The strongest wobble of `n_tried` frequencies, half as far apart as a record can tell; none
/// where nothing repeats.
fn wobbling(since_s: &[f64], off: &[f64], noise: f64, n_tried: usize) -> Option<Wavering> {
    let n = off.len();
    let span_s = since_s[n - 1];
    let frequency_rad_s = |k: usize| TAU * 0.5 * k as f64 / span_s;
    let angles: Vec<f64> =
        (2..n_tried).map(|k| frequency_rad_s(k) * span_s / (n - 1) as f64).collect();
    let powers = spectrum::powers(off, &angles).into_iter().enumerate();
    let (strongest, _) = powers.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let wobble = FourierSeries::fit(since_s, off, frequency_rad_s(2 + strongest)).ok()?;
    let Estimate { mean, sd, .. } = wobble.frequency_rad_s;
    let all: f64 = off.iter().map(|off| off * off).sum();
    Some(Wavering {
        share: Estimate::normal(wobble.amplitude(), noise * (2.0 / n as f64).sqrt()),
        course: ("f", "Hz", Estimate::normal(mean / TAU, sd / TAU)),
        explained: all - n as f64 * wobble.noise_sd.powi(2),
        log_bayes_factor: 0.0,
    })
}

/// The cause that the runs' speed records show; none where all keep their speed.
pub(in crate::diagnosis) fn cause<'r>(all: impl Iterator<Item = &'r Wavering>) -> Option<Cause> {
    let all: Vec<&Wavering> = all.collect();
    let parameters = all.iter().flat_map(|one| [("dv", "-", one.share), one.course]);
    (!all.is_empty()).then(|| Cause {
        effect: EFFECT,
        equation: EQUATION,
        log_bayes_factor: all.iter().map(|one| one.log_bayes_factor).sum(),
        parameters: parameters.collect(),
        equivalent_to: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A speed of 0.8 m/s that is off by a share, with a ripple for noise.
    fn recorded(off: impl Fn(f64) -> f64) -> Series {
        let time_s: Vec<f64> = (0..1500).map(|k| 10.0 + 0.01 * f64::from(k)).collect();
        let ripple = |t: &f64| 1e-3 * (97.0 * t).sin() + 1e-3 * (231.0 * t).cos();
        let value = time_s.iter().map(|t| 0.8 * (1.0 + off(t - 10.0)) + ripple(t)).collect();
        Series { time_s, value }
    }

    #[test]
    fn a_carriage_that_wobbles_is_told_with_share_and_frequency() {
        let found = Wavering::of(&recorded(|t| 0.03 * (TAU * 0.4 * t + 1.0).sin()), 0.2);
        let found = found.expect("a wobble of 3 %");
        assert!((found.share.mean - 0.03).abs() < 1e-3, "{found:?}");
        let ("f", "Hz", frequency_hz) = found.course else { panic!("{found:?}") };
        assert!((frequency_hz.mean - 0.4).abs() < 1e-3, "{found:?}");
        assert!(frequency_hz.sd > 0.0, "a frequency that is known for certain");
    }

    #[test]
    fn a_carriage_that_settles_is_told_with_its_time() {
        let found = Wavering::of(&recorded(|t| -0.1 * (-t / 2.0).exp()), 0.2);
        let found = found.expect("a speed that settles");
        let ("T", "s", time_s) = found.course else { panic!("{found:?}") };
        assert!((time_s.mean - 2.0).abs() < 1e-12 && time_s.sd > 0.3, "{found:?}");
        // The mean that it is a share of is a little low itself.
        assert!((found.share.mean + 0.1).abs() < 3e-3, "{found:?}");
    }

    #[test]
    fn a_carriage_that_keeps_its_speed_to_half_a_hundredth_is_told_of_no_more() {
        assert_eq!(Wavering::of(&recorded(|_| 0.0), 0.2), None);
        assert_eq!(Wavering::of(&recorded(|t| 0.005 * (TAU * 0.4 * t).sin()), 0.2), None);
        assert_eq!(Wavering::of(&Series::default(), 0.2), None);
    }

    #[test]
    fn a_carriage_at_rest_shows_no_more_than_its_zero() {
        let mut creeping = recorded(|t| 0.2 * t);
        creeping.value.iter_mut().for_each(|speed| *speed *= 1e-3);
        assert_eq!(Wavering::of(&creeping, 0.0), None);
        assert!(Wavering::of(&creeping, 0.2).is_some());
    }
}
