//! A carriage that does not keep its speed, as its own record shows.

use std::f64::consts::TAU;

use super::facts::rough_noise;
use super::survey::Survey;
use super::verdict::Cause;
use crate::inverse::estimate::Estimate;
use crate::run::Series;

/// The effect that it is an instance of.
pub(super) const EFFECT: &str = "tank.unsteady_speed";
const EQUATION: &str = "V (1 + dv exp(-t/T)) or V (1 + dv sin(2 pi f t + e)), as recorded";

/// Least share of the speed that is told [-]: damping follows its square at most, and runs repeat
/// to some hundredths of it. By judgement.
const LEAST: f64 = 0.01;
/// Least logarithm of a Bayes factor against a steady speed and noise.
const SURE: f64 = 12.0;
/// Times in which a speed may settle [s].
const SETTLES_S: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
/// Highest frequency at which a carriage may wobble [Hz].
const FASTEST_HZ: f64 = 2.0;
/// Frequencies that are tried for each that a record could tell from the next.
const FINENESS: f64 = 10.0;
/// Rate to which a record is averaged [Hz].
const RATE_HZ: f64 = 20.0;
/// Froude number below which a carriage rests, and its channel shows no more than its zero [-].
const SLOWEST_FROUDE: f64 = 0.01;
/// Least noise of a speed, as a share of it: what is read in coarse steps has none between them.
const LEAST_NOISE: f64 = 1e-4;
/// Averages below which a record says nothing.
const FEWEST: usize = 32;

/// How a carriage left its speed in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Wavering {
    /// Share of the speed [-].
    share: Estimate,
    course: Course,
    log_bayes_factor: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Course {
    Settles { time_s: f64 },
    Wobbles { frequency_hz: f64 },
}

impl Wavering {
    /// Looks at the speed [m/s] of a run at a Froude number [-]; none where it is kept, or was not
    /// recorded.
    pub(super) fn of(speed: &Series, froude: f64) -> Option<Self> {
        let [times, speeds] = [&speed.time_s, &speed.value].map(|of| thinned(&speed.time_s, of));
        let n = speeds.len();
        let mean_m_s = speeds.iter().sum::<f64>() / n.max(1) as f64;
        if n < FEWEST || froude < SLOWEST_FROUDE || mean_m_s.abs() < f64::MIN_POSITIVE {
            return None;
        }
        let off: Vec<f64> = speeds.iter().map(|v| v / mean_m_s - 1.0).collect();
        let noise = rough_noise(&off).max(LEAST_NOISE);
        let since: Vec<f64> = times.iter().map(|t| t - times[0]).collect();
        let span_s = since[n - 1];
        let settling = SETTLES_S.map(|time_s| {
            let fades = centred(since.iter().map(|t| (-t / time_s).exp()));
            (Course::Settles { time_s }, along(&off, &[fades]))
        });
        let n_tried = (FINENESS * FASTEST_HZ * span_s) as usize;
        let wobbling = (FINENESS as usize..n_tried).map(|k| {
            let frequency_hz = k as f64 / (FINENESS * span_s);
            let turn = |t: &f64| (TAU * frequency_hz * t).sin_cos();
            let sine = centred(since.iter().map(|t| turn(t).0));
            let cosine = centred(since.iter().map(|t| turn(t).1));
            (Course::Wobbles { frequency_hz }, along(&off, &[sine, cosine]))
        });
        let all = settling.into_iter().chain(wobbling);
        let (course, Along { share, sd_per_noise, explained }) =
            all.max_by(|a, b| a.1.explained.total_cmp(&b.1.explained))?;
        let n_all = SETTLES_S.len() + n_tried;
        let log_bayes_factor = 0.5 * explained / noise.powi(2) - (n_all as f64).ln();
        let share = Estimate::normal(share, sd_per_noise * noise);
        let is_told = share.mean.abs() > LEAST && log_bayes_factor > SURE;
        is_told.then_some(Self { share, course, log_bayes_factor })
    }
}

/// Averages of values over as many samples as come in a twentieth of a second.
fn thinned(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let (Some(first_s), Some(last_s)) = (time_s.first(), time_s.last()) else {
        return Vec::new();
    };
    let rate_hz = time_s.len() as f64 / (last_s - first_s).max(f64::MIN_POSITIVE);
    let width = ((rate_hz / RATE_HZ) as usize).max(1);
    let average = |block: &[f64]| block.iter().sum::<f64>() / width as f64;
    values.chunks_exact(width).map(average).collect()
}

/// What a course explains of a record.
struct Along {
    /// Its size; of a course with two parts that of both together.
    share: f64,
    /// Standard deviation of that under noise of one.
    sd_per_noise: f64,
    /// Sum of squares that it takes away.
    explained: f64,
}

/// Least squares of a record along one part or two.
fn along(off: &[f64], parts: &[Vec<f64>]) -> Along {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let first = &parts[0];
    let size = dot(first, first).max(f64::MIN_POSITIVE);
    let mut share = dot(off, first) / size;
    let mut explained = share * share * size;
    if let Some(second) = parts.get(1) {
        let common = dot(first, second) / size;
        let rest: Vec<f64> = second.iter().zip(first).map(|(s, f)| s - common * f).collect();
        let rest_size = dot(&rest, &rest).max(f64::MIN_POSITIVE);
        let other = dot(off, &rest) / rest_size;
        explained += other * other * rest_size;
        share = (share - common * other).hypot(other);
    }
    Along { share, sd_per_noise: size.sqrt().recip(), explained }
}

/// Values less their mean.
fn centred(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = values.collect();
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    for value in &mut all {
        *value -= mean;
    }
    all
}

/// The cause that the runs' speed records show; none where all keep their speed.
pub(super) fn cause(survey: &Survey) -> Option<Cause> {
    let all: Vec<&Wavering> = survey.runs.iter().filter_map(|run| run.wavering.as_ref()).collect();
    let parameters = all.iter().flat_map(|one| {
        let course = match one.course {
            Course::Settles { time_s } => ("T", "s", Estimate::normal(time_s, 0.0)),
            Course::Wobbles { frequency_hz } => ("f", "Hz", Estimate::normal(frequency_hz, 0.0)),
        };
        [("dv", "-", one.share), course]
    });
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
        let Course::Wobbles { frequency_hz } = found.course else { panic!("{found:?}") };
        assert!((frequency_hz - 0.4).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn a_carriage_that_settles_is_told_with_its_time() {
        let found = Wavering::of(&recorded(|t| -0.1 * (-t / 2.0).exp()), 0.2);
        let found = found.expect("a speed that settles");
        assert_eq!(found.course, Course::Settles { time_s: 2.0 });
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
