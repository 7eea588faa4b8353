//! The diagnosis of the runs, and of what the model did after its decays where that is explained.

use super::growth::{Grown, Stem, grow};
use super::observation::Observation;
use super::reversed::Reversed;
use super::survey::Survey;
use super::verdict::{Diagnosis, Verdict, told};
use crate::campaign::Tank;

/// Periods of a decay over which a model that starts far away still follows it.
const FIRST_PERIODS: f64 = 6.0;

/// What a campaign has brought for its diagnosis.
#[derive(Debug, Clone, Default)]
pub struct Gathered {
    /// The runs.
    pub runs: Vec<Observation>,
    /// The same with what the model did after its decays; empty where it did nothing.
    pub whole: Vec<Observation>,
    /// Runs that were refused for the sign of their force.
    pub reversed: Vec<Reversed>,
}

/// Diagnoses the runs of a campaign; none without runs.
///
/// What comes after a decay may be a beat with water in the hull or waves back from the walls, or a
/// hand: it is believed where it is explained to the last.
pub fn diagnose(gathered: Gathered, tank: &Tank) -> Option<Diagnosis> {
    let Gathered { runs, whole, reversed } = gathered;
    if runs.is_empty() {
        return None;
    }
    let survey = Survey::new(runs);
    let grown = grow(&survey, None);
    let tell = &|survey: &Survey, grown: &Grown| told(survey, grown, &reversed, tank);
    let explained = if whole.is_empty() { None } else { explained(whole, &survey, &grown, tell) };
    Some(explained.unwrap_or_else(|| tell(&survey, &grown)))
}

/// The diagnosis with what the model did after its decays, where that explains it: from what the
/// decays alone say, which may lead astray, from the first periods, or from nothing.
fn explained(
    whole: Vec<Observation>,
    survey: &Survey,
    grown: &Grown,
    tell: &dyn Fn(&Survey, &Grown) -> Diagnosis,
) -> Option<Diagnosis> {
    let short = whole.iter().map(|run| run.clone().first_periods(FIRST_PERIODS));
    let short = Survey::new(short.collect());
    let whole = Survey::new(whole);
    let told_from = |stem| {
        let diagnosis = tell(&whole, &grow(&whole, stem));
        (diagnosis.verdict != Verdict::Unexplained).then_some(diagnosis)
    };
    let first = stem(&whole, survey, grown).and_then(|stem| told_from(Some(stem)));
    let of_short = || stem(&whole, &short, &grow(&short, None));
    let second = || of_short().and_then(|stem| told_from(Some(stem)));
    first.or_else(second).or_else(|| told_from(None))
}

/// What has grown on other records of the same runs, where that is more than the base model.
fn stem(whole: &Survey, survey: &Survey, grown: &Grown) -> Option<Stem> {
    if grown.entered.is_empty() {
        return None;
    }
    Some(Stem {
        fit: whole.adopted(survey, &grown.last.fit)?,
        entered: grown.entered.clone(),
        ranking: grown.ranking.clone(),
    })
}
