//! The diagnosis of the runs, and of what the model did after its decays where that is explained.

use super::growth::{Grown, Stem, grow};
use super::observation::Observation;
use super::reversed::Reversed;
use super::survey::Survey;
use super::verdict::{Diagnosis, Verdict, told};
use crate::campaign::Tank;

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
    let explained = (!whole.is_empty()).then(|| Survey::new(whole)).and_then(|whole| {
        let stem = stem(&whole, &survey, &grown);
        let told_from = |stem| {
            let diagnosis = told(&whole, &grow(&whole, stem), &reversed, tank);
            (diagnosis.verdict != Verdict::Unexplained).then_some(diagnosis)
        };
        // What the decays alone say is near what all says; that may also lead astray.
        let first = stem.and_then(|stem| told_from(Some(stem)));
        first.or_else(|| told_from(None))
    });
    Some(explained.unwrap_or_else(|| told(&survey, &grown, &reversed, tank)))
}

/// What has grown on the decays alone, where that is more than the base model.
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
