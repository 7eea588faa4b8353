//! Records without the carriage's shaking, which hides what else a model lacks.

use std::f64::consts::TAU;

use super::observation::Observation;
use super::records::Shown;
use super::survey::{Fit, Survey};
use crate::model::{Line, Recurs};

/// How far a line is sought from where the speed has it, and in which steps, in widths of a line.
const SOUGHT: f64 = 0.6;
const STEP: f64 = 0.05;
/// Least strength of a line that is taken out, in its standard deviations.
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
    let n_steps = (SOUGHT / STEP) as i32;
    let around = (-n_steps..=n_steps).map(|k| expected_hz + f64::from(k) * STEP / span_s);
    let tones = around.map(|hz| Tone::of(times, left, hz));
    let Some(tone) = tones.max_by(|a, b| a.amplitude().total_cmp(&b.amplitude())) else { return };
    let amplitude_sd_rad = run.rough_noise[0] * (2.0 / left.len() as f64).sqrt();
    if tone.amplitude() < SEEN * amplitude_sd_rad {
        return;
    }
    let less: Vec<f64> = times.iter().map(|t| tone.at(*t)).collect();
    run.roll_rad.iter_mut().zip(less).for_each(|(roll, less)| *roll -= less);
    let log_bayes_factor = 0.5 * (tone.amplitude() / amplitude_sd_rad).powi(2);
    run.facts.line = Some(Line {
        frequency_hz: tone.frequency_hz,
        amplitude_rad: tone.amplitude(),
        amplitude_sd_rad,
        log_bayes_factor,
    });
    run.facts.line_band_hz[0] = 0.0;
}

/// `a cos(2 pi f t) + b sin(2 pi f t)`.
struct Tone {
    frequency_hz: f64,
    cosine: f64,
    sine: f64,
}

impl Tone {
    /// The tone of a frequency [Hz] in values at their times [s], by least squares.
    fn of(times: &[f64], values: &[f64], frequency_hz: f64) -> Self {
        let (mut cc, mut cs, mut ss, mut cv, mut sv) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (t, value) in times.iter().zip(values) {
            let (sin, cos) = (TAU * frequency_hz * t).sin_cos();
            cc += cos * cos;
            cs += cos * sin;
            ss += sin * sin;
            cv += cos * value;
            sv += sin * value;
        }
        let determinant = cc * ss - cs * cs;
        Self {
            frequency_hz,
            cosine: (ss * cv - cs * sv) / determinant,
            sine: (cc * sv - cs * cv) / determinant,
        }
    }

    fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }

    fn at(&self, time_s: f64) -> f64 {
        let (sin, cos) = (TAU * self.frequency_hz * time_s).sin_cos();
        self.cosine * cos + self.sine * sin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_is_what_it_was_made_of() {
        let times: Vec<f64> = (0..700).map(|k| 0.01 * f64::from(k)).collect();
        let made = Tone { frequency_hz: 2.9, cosine: 0.3, sine: -0.4 };
        let values: Vec<f64> = times.iter().map(|t| made.at(*t)).collect();
        let found = Tone::of(&times, &values, 2.9);
        assert!((found.cosine - 0.3).abs() < 1e-9 && (found.sine + 0.4).abs() < 1e-9);
        assert!((found.amplitude() - 0.5).abs() < 1e-9);
        assert!(Tone::of(&times, &values, 3.1).amplitude() < 0.35);
    }
}
