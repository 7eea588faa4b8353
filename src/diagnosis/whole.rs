//! The diagnosis of the runs, and of what the model did after its decays where that is explained.

use std::cell::OnceCell;
use std::sync::Arc;

use super::fit::cost::Spent;
use super::fit::settle::settle;
use super::fit::survey::{Fit, Survey};
use super::record::observation::Observation;
use super::record::reversed::Reversed;
use super::search::alike::{SAME, is_approximate};
use super::search::entry::CRUMB_OF_EVIDENCE;
use super::search::growth::{Grown, grow};
use super::search::stem::Stem;
use super::shaking;
use super::told::diagnosis::{Diagnosis, told};
use super::told::verdict::{Judged, Verdict, judged};
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
    let judge = &|survey: &Survey, grown: Grown| {
        let judged = judged(survey, &grown, &reversed);
        Explained { grown, judged }
    };
    let spent = Arc::new(Spent::default());
    let of_one_kind = Parts::of(&runs, &spent);
    let mut survey = Survey::new(runs, &spent);
    let mut grown = grow(&survey, None);
    if let Some(calm) = shaking::without(&survey, &grown.last.fit) {
        survey = Survey::new(calm, &spent);
        grown = grow(&survey, None);
    }
    let mut together = judge(&survey, grown);
    if together.judged.left() > 0.0 {
        let mut others =
            of_one_kind.stems(&survey).map(|stem| judge(&survey, grow(&survey, Some(stem))));
        if let Some(other) = others.find(|other| other.leaves_less_than(&together)) {
            together = other;
        }
    }
    if !whole.is_empty() {
        let short = whole.iter().map(|run| run.clone().first_periods(FIRST_PERIODS));
        let short = Survey::new(short.collect(), &spent);
        let whole = Survey::new(whole, &spent);
        let explained = explained(&whole, &short, &survey, &together.grown, &of_one_kind, judge);
        // Nor is it known, where this search was cut short, what another would have found.
        together.grown.is_cut_short |= whole.cost.is_spent();
        // What names more of what the runs alone show is better than what explains what came
        // after, unless that does as well for the runs.
        let names_enough = |of_whole: &Explained| {
            together.judged.verdict == Verdict::Unexplained
                || of_whole.judged.causes.len() >= together.judged.causes.len()
                || does_as_well(of_whole, &whole, &together, &survey)
        };
        if let Some(of_whole) = explained.filter(names_enough) {
            return Some(told(&whole, of_whole.grown, of_whole.judged, tank));
        }
    }
    Some(told(&survey, together.grown, together.judged, tank))
}

/// A model that has grown, as it is judged.
struct Explained {
    grown: Grown,
    judged: Judged,
}

/// Share of what one model leaves that a better one may; by judgement.
const LESS: f64 = 0.5;

impl Explained {
    fn leaves_less_than(&self, other: &Self) -> bool {
        self.judged.left() < LESS * other.judged.left()
    }
}

/// Whether a model of the whole records is as probable under the runs alone as what grew on them,
/// but for what may be a want of an approximate form: little beside what that explains of all that
/// is recorded or, where what grew on the runs holds it with more, beside what it explains there.
fn does_as_well(
    of_whole: &Explained,
    whole: &Survey,
    together: &Explained,
    survey: &Survey,
) -> bool {
    let grown = &together.grown;
    let Some(of_runs) = survey.adopted(whole, &of_whole.grown.last.fit) else { return false };
    let log = |fit: Fit| settle(survey, fit, &grown.noise).log_evidence;
    let (log_of_whole, log_of_runs) = (log(of_runs), log(grown.last.fit.clone()));
    let forms = || of_whole.grown.entered.iter().filter(|one| is_approximate(one.id));
    let of_forms = if of_whole.judged.is_part_of(&together.judged) {
        forms().next().map_or(0.0, |_| log_of_whole - grown.base.log_evidence)
    } else {
        forms().map(|one| one.log_bayes_factor).fold(0.0, f64::max)
    };
    let behind = log_of_runs - log_of_whole;
    let want = SAME.max(CRUMB_OF_EVIDENCE * of_forms);
    tracing::debug!(behind, want, "what explains what came after, under the runs alone");
    behind < want
}

/// What explains the runs with what the model did after its decays: from what the decays alone
/// say, which may lead astray, from the first periods, from runs of one kind, or from nothing.
fn explained(
    whole: &Survey,
    short: &Survey,
    survey: &Survey,
    grown: &Grown,
    of_one_kind: &Parts,
    judge: &dyn Fn(&Survey, Grown) -> Explained,
) -> Option<Explained> {
    let from = |stem| {
        let explained = judge(whole, grow(whole, stem));
        (explained.judged.verdict != Verdict::Unexplained).then_some(explained)
    };
    let first = || stem(whole, survey, grown).and_then(|stem| from(Some(stem)));
    let of_short = || stem(whole, short, &grow(short, None));
    let second = || of_short().and_then(|stem| from(Some(stem)));
    let third = || of_one_kind.stems(whole).find_map(|stem| from(Some(stem)));
    let fourth = || from(None);
    // One that explains all is looked for no further; of others the one that leaves least counts.
    let ways: [&dyn Fn() -> Option<Explained>; 4] = [&first, &second, &third, &fourth];
    let mut best: Option<Explained> = None;
    for way in ways {
        let is_enough = |best: &Explained| best.judged.left() <= 0.0 || whole.cost.is_spent();
        if best.as_ref().is_some_and(is_enough) {
            break;
        }
        let Some(other) = way() else { continue };
        if best.as_ref().is_none_or(|best| other.leaves_less_than(best)) {
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
