//! Records without the carriage's shaking, which hides what else a model lacks.

use std::f64::consts::TAU;

use super::fit::survey::{Fit, Survey};
use super::record::observation::Observation;
use super::shown::Shown;
use crate::inverse::forced::harmonic::FourierSeries;
use crate::model::{Line, Recurs};

/// Least amplitude of a line that is taken out, in its standard deviations.
const SEEN: f64 = 3.0;

/// The runs less the line that goes with their speed, which each of them keeps among its facts;
/// none where the records, and what a model leaves of them, show no such line.
pub(super) fn without(survey: &Survey, fit: &Fit) -> Option<Vec<Observation>> {
    let line = Shown::of(survey, fit).in_proportion()?;
    let calm = |r: usize| {
        let mut run = Observation::clone(&survey.runs[r]);
        let n = run.roll_rad.len();
        take_out(&mut run, &survey.residual(fit, r)[..n], line);
        run
    };
    Some(survey.each_run(&calm))
}

/// Takes the line out of a run, where what a model leaves of its roll [rad] has it.
fn take_out(run: &mut Observation, left: &[f64], line: Recurs) {
    let times = &run.roll_time_s;
    let (Some(first_s), Some(last_s)) = (times.first(), times.last()) else { return };
    let span_s = last_s - first_s;
    let expected_hz = line.frequency_hz(run.at.froude);
    if expected_hz * span_s < 1.0 {
        return;
    }
    let Ok(shaking) = FourierSeries::fit(times, left, TAU * expected_hz) else { return };
    let (cosine, sine) = shaking.pairs[0];
    let amplitude_sd_rad = run.rough_noise[0] * (2.0 / left.len() as f64).sqrt();
    if shaking.amplitude() < SEEN * amplitude_sd_rad {
        return;
    }
    let w = shaking.frequency_rad_s.mean;
    let less = times.iter().map(|t| cosine * (w * t).cos() + sine * (w * t).sin());
    run.roll_rad.iter_mut().zip(less).for_each(|(roll, less)| *roll -= less);
    let log_bayes_factor = 0.5 * (shaking.amplitude() / amplitude_sd_rad).powi(2);
    run.facts.line = Some(Line {
        frequency_hz: w / TAU,
        amplitude_rad: shaking.amplitude(),
        amplitude_sd_rad,
        log_bayes_factor,
    });
    run.facts.line_band_hz[0] = 0.0;
}
