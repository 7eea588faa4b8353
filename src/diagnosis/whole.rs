//! The diagnosis of the runs, and of what the model did after its decays where that is explained.

use std::cell::OnceCell;
use std::sync::Arc;

use super::fit::cost::Spent;
use super::fit::settle::settle;
use super::fit::survey::{Fit, Survey};
use super::record::observation::Observation;
use super::record::reversed::Reversed;
use super::search::alike::{SAME, is_approximate};
use super::search::entered::Entered;
use super::search::entry::CRUMB_OF_EVIDENCE;
use super::search::growth::{Grown, Stem, grow};
use super::shaking;
use super::told::verdict::{Diagnosis, Verdict, told};
use crate::campaign::Tank;
use crate::run::RunKind;

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
/// hand: it is believed where it is explained to the last. Where the runs together are not
/// explained, the decays or the forced runs alone may say from where they would be.
pub fn diagnose(gathered: Gathered, tank: &Tank) -> Option<Diagnosis> {
    let Gathered { runs, whole, reversed } = gathered;
    if runs.is_empty() {
        return None;
    }
    let tell = &|survey: &Survey, grown: &Grown| told(survey, grown, &reversed, tank);
    let spent = Arc::new(Spent::default());
    let of_one_kind = Parts::of(&runs, &spent);
    let mut survey = Survey::new(runs, &spent);
    let mut grown = grow(&survey, None);
    if let Some(calm) = shaking::without(&survey, &grown.last.fit) {
        survey = Survey::new(calm, &spent);
        grown = grow(&survey, None);
    }
    let mut together = tell(&survey, &grown);
    if left(&together) > 0.0 {
        for stem in of_one_kind.stems(&survey) {
            let other = grow(&survey, Some(stem));
            let diagnosis = tell(&survey, &other);
            if left(&diagnosis) < LESS * left(&together) {
                (grown, together) = (other, diagnosis);
                break;
            }
        }
    }
    let explained =
        if whole.is_empty() { None } else { explained(whole, &survey, &grown, &of_one_kind, tell) };
    // What names more of what the runs alone show is better than what explains what came after,
    // unless that does as well for the runs.
    let names_enough = |whole: &Whole| {
        together.verdict == Verdict::Unexplained
            || whole.diagnosis.causes.len() >= together.causes.len()
            || whole.does_as_well(&survey, &grown)
    };
    Some(explained.filter(names_enough).map_or(together, |whole| whole.diagnosis))
}

/// What explains the runs with what the model did after its decays.
struct Whole {
    diagnosis: Diagnosis,
    entered: Vec<Entered>,
    /// Its model as it stands in the runs alone.
    of_runs: Option<Fit>,
}

impl Whole {
    /// Whether it is as probable under the runs alone as what grew on them, but for what may be a
    /// want of an approximate form.
    fn does_as_well(&self, survey: &Survey, grown: &Grown) -> bool {
        let Some(of_runs) = &self.of_runs else { return false };
        let log = |fit: &Fit| settle(survey, fit.clone(), &grown.noise).log_evidence;
        let behind = log(&grown.last.fit) - log(of_runs);
        let forms = self.entered.iter().filter(|one| is_approximate(one.id));
        let want = forms.map(|one| CRUMB_OF_EVIDENCE * one.log_bayes_factor).fold(SAME, f64::max);
        tracing::debug!(behind, want, "what explains what came after, under the runs alone");
        behind < want
    }
}

/// Share of what one diagnosis leaves that a better one may; by judgement.
const LESS: f64 = 0.5;

/// What a diagnosis leaves for sure, as a share of the motion; nothing counts as explained by one
/// that says that it does not explain the runs.
fn left(diagnosis: &Diagnosis) -> f64 {
    if diagnosis.verdict == Verdict::Unexplained {
        return f64::INFINITY;
    }
    let sure = diagnosis.left_after.iter().filter(|left| left.is_sure());
    sure.map(|left| left.share).sum()
}

/// The diagnosis with what the model did after its decays, where that explains it: from what the
/// decays alone say, which may lead astray, from the first periods, from runs of one kind, or from
/// nothing.
fn explained(
    whole: Vec<Observation>,
    survey: &Survey,
    grown: &Grown,
    of_one_kind: &Parts,
    tell: &dyn Fn(&Survey, &Grown) -> Diagnosis,
) -> Option<Whole> {
    let short = whole.iter().map(|run| run.clone().first_periods(FIRST_PERIODS));
    let spent = survey.cost.spent();
    let short = Survey::new(short.collect(), spent);
    let whole = Survey::new(whole, spent);
    let told_from = |stem| {
        let grown = grow(&whole, stem);
        let diagnosis = tell(&whole, &grown);
        let of_runs = survey.adopted(&whole, &grown.last.fit);
        let is_explained = diagnosis.verdict != Verdict::Unexplained;
        is_explained.then_some(Whole { diagnosis, entered: grown.entered, of_runs })
    };
    let first = || stem(&whole, survey, grown).and_then(|stem| told_from(Some(stem)));
    let of_short = || stem(&whole, &short, &grow(&short, None));
    let second = || of_short().and_then(|stem| told_from(Some(stem)));
    let third = || of_one_kind.stems(&whole).find_map(|stem| told_from(Some(stem)));
    let fourth = || told_from(None);
    // One that explains all is looked for no further; of others the one that leaves least counts.
    let ways: [&dyn Fn() -> Option<Whole>; 4] = [&first, &second, &third, &fourth];
    let mut best: Option<Whole> = None;
    for way in ways {
        if best.as_ref().is_some_and(|best| left(&best.diagnosis) <= 0.0 || whole.cost.is_spent()) {
            break;
        }
        let Some(other) = way() else { continue };
        if best.as_ref().is_none_or(|best| left(&other.diagnosis) < LESS * left(&best.diagnosis)) {
            best = Some(other);
        }
    }
    best
}

/// The runs of each kind, where there are both.
struct Parts(Vec<Part>);

/// The runs of one kind, and what has grown on them once that was asked.
struct Part {
    survey: Survey,
    grown: OnceCell<Grown>,
}

impl Parts {
    fn of(runs: &[Observation], spent: &Arc<Spent>) -> Self {
        let of_kind = |kind| -> Vec<Observation> {
            runs.iter().filter(|run| run.at.kind == kind).cloned().collect()
        };
        let parts = [RunKind::Decay, RunKind::Forced].map(of_kind);
        if parts.iter().any(Vec::is_empty) {
            return Self(Vec::new());
        }
        let part = |runs| Part { survey: Survey::new(runs, spent), grown: OnceCell::new() };
        Self(parts.into_iter().map(part).collect())
    }

    /// What has grown on the runs of each kind alone, from which a model of all may grow.
    fn stems(&self, survey: &Survey) -> impl Iterator<Item = Stem> {
        self.0.iter().filter_map(|Part { survey: part, grown }| {
            stem(survey, part, grown.get_or_init(|| grow(part, None)))
        })
    }
}

/// What has grown on other records of the same runs, or of some of them, where that is more than
/// the base model.
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
