//! The frequency of a roll that repeats, where the force still settled and told none.

use crate::inverse::forced::harmonic::FourierSeries;
use crate::run::{Run, RunKind};

/// Half periods without which nothing repeats.
const LEAST_CROSSINGS: usize = 7;
/// Share of the amplitude that a roll may be off its series and still repeat [-]; by judgement, far
/// above the noise of any roll worth a run and far below what a sweep or a decay is off.
const MOST_OFF: f64 = 0.03;
/// Share of the amplitude by which the roll must cross its mean to count [-].
const CROSSED: f64 = 0.2;

/// The run with the frequency of its roll, where it is a forced one without any, whose roll repeats
/// in its middle half: the rod may start and stop at its ends.
pub(super) fn with_frequency(run: &Run) -> Option<Run> {
    if run.kind != RunKind::Forced || run.excitation_rad_s.is_some() {
        return None;
    }
    let n = run.roll.time_s.len();
    let middle = n / 4..n - n / 4;
    let time_s: Vec<f64> =
        run.roll.time_s[middle.clone()].iter().map(|t| t - run.start_s).collect();
    let frequency_rad_s = frequency_rad_s(&time_s, &run.roll.value[middle])?;
    Some(Run { excitation_rad_s: Some(frequency_rad_s), ..run.clone() })
}

/// Frequency [rad/s] of a roll [rad] that repeats all along.
fn frequency_rad_s(time_s: &[f64], roll_rad: &[f64]) -> Option<f64> {
    let n = roll_rad.len() as f64;
    let mean = roll_rad.iter().sum::<f64>() / n;
    let amplitude = (2.0 * roll_rad.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / n).sqrt();
    let mut crossings_s: Vec<f64> = Vec::new();
    let (mut side, mut near_s) = (0.0, 0.0);
    for (t, roll) in time_s.iter().zip(roll_rad) {
        let off = roll - mean;
        if side * off >= 0.0 {
            near_s = *t;
        }
        if off.abs() > CROSSED * amplitude && side * off <= 0.0 {
            if side != 0.0 {
                crossings_s.push(near_s);
            }
            side = off.signum();
            near_s = *t;
        }
    }
    let [first_s, .., last_s] = crossings_s[..] else { return None };
    if crossings_s.len() < LEAST_CROSSINGS {
        return None;
    }
    let near = std::f64::consts::PI * (crossings_s.len() - 1) as f64 / (last_s - first_s);
    let series = FourierSeries::fit(time_s, roll_rad, near).ok()?;
    let off = time_s.iter().zip(roll_rad).map(|(t, roll)| (series.at(*t).value - roll).powi(2));
    let is_steady = (off.sum::<f64>() / n).sqrt() < MOST_OFF * series.amplitude();
    is_steady.then_some(series.frequency_rad_s.mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_its_frequency_and_a_decay_has_none() {
        let time_s: Vec<f64> = (0..1000).map(|k| 0.02 * f64::from(k)).collect();
        let noise = |t: f64| 0.001 * (977.0 * t).sin();
        let of = |roll: &dyn Fn(f64) -> f64| -> Vec<f64> {
            time_s.iter().map(|t| 0.02 + roll(*t) + noise(*t)).collect()
        };
        let found = frequency_rad_s(&time_s, &of(&|t| 0.1 * (5.12 * t).sin()));
        assert!(found.is_some_and(|w| (w - 5.12).abs() < 1e-3), "{found:?}");
        let decay = of(&|t| 0.1 * (-0.05 * t).exp() * (5.12 * t).sin());
        assert_eq!(frequency_rad_s(&time_s, &decay), None);
        let sweep = of(&|t| 0.1 * (4.0 * t + 0.05 * t * t).sin());
        assert_eq!(frequency_rad_s(&time_s, &sweep), None);
    }
}
