//! Causes that a record shows by itself: its steps, and lines in its noise.

use std::f64::consts::TAU;

use super::cause::Cause;
use super::fit::survey::{Fit, Survey};
use super::record::facts::SURE;
use super::record::observation::Observation;
use super::record::shared_line::{Shared, Spectrum};
use crate::inverse::estimate::Estimate;
use crate::model::effects;
use crate::model::{Acts, Effect, Facts, Recurs, Seen};

/// Deviation [Hz], and as a share, within which two records show one line.
const ONE_LINE_HZ: f64 = 0.15;
const ONE_LINE_SHARE: f64 = 0.02;
/// Share of the best evidence for a line with which the first of two causes is told [-].
const MOST_OF_A_LINE: f64 = 0.95;

/// What the records show of one effect.
struct Found {
    log_bayes_factor: f64,
    cause: Cause,
    recurs: Option<Recurs>,
}

/// What the records show, where the runs that can show it do.
pub(super) struct Shown(Vec<Found>);

impl Shown {
    /// Of all runs together, with a line that they share in what a model leaves of them.
    pub(super) fn of(survey: &Survey, fit: &Fit) -> Self {
        let mut found = found(survey);
        found.extend(found_left(survey, fit));
        // One line has one cause: the one that explains it in more runs, the first of equals.
        let lines = found.iter().filter(|found| found.recurs.is_some());
        let best = lines.map(|found| found.log_bayes_factor).fold(f64::NEG_INFINITY, f64::max);
        let mut line_told = false;
        found.retain(|found| {
            let explains = found.log_bayes_factor > MOST_OF_A_LINE * best;
            let keeps = found.recurs.is_none() || (!line_told && explains);
            line_told |= keeps && found.recurs.is_some();
            keeps
        });
        Self(found)
    }

    /// The line that goes with the speed.
    pub(super) fn in_proportion(&self) -> Option<Recurs> {
        let mut lines = self.0.iter().filter_map(|found| found.recurs);
        lines.find(|line| matches!(line, Recurs::PerFroude(_)))
    }

    /// Whether a line that the records show is what is left at a frequency [rad/s] of a run.
    pub(super) fn tells(&self, survey: &Survey, run: &str, frequency_rad_s: f64) -> bool {
        let Some(run) = survey.runs.iter().find(|observed| observed.id == run) else {
            return false;
        };
        let hz = frequency_rad_s / std::f64::consts::TAU;
        let resolution_hz = 1.5 / run.at.span_s;
        let lines = self.0.iter().filter_map(|found| found.recurs);
        let mut expected = lines.map(|line| line.frequency_hz(run.at.froude));
        expected.any(|line_hz| (line_hz - hz).abs() < resolution_hz + ONE_LINE_SHARE * hz)
    }

    /// The causes.
    pub(super) fn causes(self) -> impl Iterator<Item = Cause> {
        self.0.into_iter().map(|found| found.cause)
    }
}

fn found(survey: &Survey) -> Vec<Found> {
    let mut found: Vec<Found> = Vec::new();
    for effect in effects::all() {
        let Acts::Record(sees) = effect.acts else { continue };
        let able: Vec<&Observation> =
            survey.runs.iter().map(|run| &**run).filter(|run| (effect.shows)(&run.at)).collect();
        let seen: Vec<(&Observation, Seen)> =
            able.iter().filter_map(|run| Some((*run, sees(&run.facts)?))).collect();
        let is_line = seen.iter().any(|(_, seen)| seen.recurs.is_some());
        let band = |run: &Observation| run.facts.line_band_hz;
        let told = if is_line { one_line(&able, &seen, &band) } else { Some(seen) };
        let Some(seen) = told else { continue };
        let log_bayes_factor = seen.iter().map(|(_, seen)| seen.log_bayes_factor).sum();
        if log_bayes_factor > SURE {
            let recurs = seen[0].1.recurs;
            let seen: Vec<Seen> = seen.into_iter().map(|(_, seen)| seen).collect();
            let cause = cause(effect, &seen, log_bayes_factor);
            found.push(Found { log_bayes_factor, cause, recurs });
        }
    }
    found
}

/// The effect whose line the runs share in what a model leaves.
fn found_left(survey: &Survey, fit: &Fit) -> Option<Found> {
    let spectra = survey.each_run(&|r| {
        let run = &survey.runs[r];
        let n = run.roll_rad.len();
        let span_s = run.roll_time_s.last()? - run.roll_time_s.first()?;
        let (rate_hz, rolling_hz) = ((n - 1) as f64 / span_s, run.at.rolling_rad_s / TAU);
        Spectrum::of(&survey.residual(fit, r)[..n], rate_hz, run.at.froude, rolling_hz)
    });
    let shared = Shared::of(&spectra, SURE)?;
    let facts: Vec<Facts> = survey
        .runs
        .iter()
        .zip(shared.lines)
        .map(|(run, line)| Facts { line, ..run.facts })
        .collect();
    let of_effect = |effect: &'static Effect| {
        let Acts::Record(sees) = effect.acts else { return None };
        let able = survey.runs.iter().zip(&facts).filter(|(run, _)| (effect.shows)(&run.at));
        let seen: Vec<Seen> = able
            .filter_map(|(_, facts)| sees(facts))
            .filter(|seen| seen.recurs.is_some_and(|own| own.is_alike(&shared.recurs)))
            .collect();
        let log_bayes_factor: f64 = seen.iter().map(|seen| seen.log_bayes_factor).sum();
        let told = || Found {
            log_bayes_factor,
            cause: cause(effect, &seen, log_bayes_factor),
            recurs: Some(shared.recurs),
        };
        (log_bayes_factor > SURE).then(told)
    };
    effects::all().iter().find_map(of_effect)
}

/// The records that show one and the same line, the surest first, if half of those in whose band
/// [Hz] it lies do: a line belongs to the chain or the carriage and not to one record.
fn one_line<'s>(
    able: &[&Observation],
    seen: &[(&'s Observation, Seen)],
    band: &dyn Fn(&Observation) -> [f64; 2],
) -> Option<Vec<(&'s Observation, Seen)>> {
    let group = |line: Recurs| -> Vec<(&'s Observation, Seen)> {
        let is_same = |(run, seen): &&(&Observation, Seen)| {
            let expected_hz = line.frequency_hz(run.at.froude);
            let hz = seen.recurs.map_or(f64::NAN, |own| own.frequency_hz(run.at.froude));
            let off_hz = (hz - expected_hz).abs();
            seen.log_bayes_factor > 0.0 && off_hz < ONE_LINE_HZ.max(ONE_LINE_SHARE * expected_hz)
        };
        let mut group: Vec<_> = seen.iter().filter(is_same).cloned().collect();
        group.sort_by(|a, b| b.1.log_bayes_factor.total_cmp(&a.1.log_bayes_factor));
        group
    };
    let sum = |group: &[(&Observation, Seen)]| -> f64 {
        group.iter().map(|(_, seen)| seen.log_bayes_factor).sum()
    };
    let lines = seen.iter().filter_map(|(_, seen)| seen.recurs);
    let (line, best) =
        lines.map(|line| (line, group(line))).max_by(|a, b| sum(&a.1).total_cmp(&sum(&b.1)))?;
    let could = |run: &&&Observation| {
        let [low, high] = band(run);
        (low..high).contains(&line.frequency_hz(run.at.froude))
    };
    let n_could = able.iter().filter(could).count();
    (2 * best.len() >= n_could && !best.is_empty()).then_some(best)
}

fn cause(effect: &'static Effect, seen: &[Seen], total: f64) -> Cause {
    let parameters = effect
        .strengths
        .iter()
        .enumerate()
        .map(|(k, parameter)| {
            let values: Vec<(f64, f64)> =
                seen.iter().filter_map(|s| s.values.get(k).copied()).collect();
            let weight: f64 = values.iter().map(|(_, sd)| sd.powi(-2)).sum();
            let mean = values.iter().map(|(v, sd)| v * sd.powi(-2)).sum::<f64>() / weight;
            (parameter.symbol, parameter.unit, Estimate::normal(mean, weight.sqrt().recip()))
        })
        .collect();
    Cause {
        effect: effect.id,
        equation: effect.equation,
        log_bayes_factor: total,
        parameters,
        equivalent_to: Vec::new(),
    }
}
