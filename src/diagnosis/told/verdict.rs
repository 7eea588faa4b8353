//! The verdict on a grown model: its causes, its suspects, and what it leaves.

use super::partial::{is_part, n_parts};
use crate::diagnosis::cause::Cause;
use crate::diagnosis::fit::layout::Layout;
use crate::diagnosis::fit::leftover::{Leftover, leftovers};
use crate::diagnosis::fit::survey::Survey;
use crate::diagnosis::record::reversed::{self, Reversed};
use crate::diagnosis::record::wavering;
use crate::diagnosis::search::entry::ENTERS_BESIDE;
use crate::diagnosis::search::growth::Grown;
use crate::diagnosis::shown::Shown;
use crate::inverse::estimate::Estimate;
use crate::model::effects;
use crate::run::RunKind;

/// The verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is wrong.
    Adequate,
    /// The causes are known.
    Named,
    /// These runs cannot part some cause from others.
    Ambiguous,
    /// Structure is left that no effect explains.
    Unexplained,
}

/// A grown model as it is judged.
pub(in crate::diagnosis) struct Judged {
    pub(in crate::diagnosis) verdict: Verdict,
    /// In order of entry.
    pub(in crate::diagnosis) causes: Vec<Cause>,
    /// Effects that explain a part of what they found, most of which remains unexplained.
    pub(super) suspects: Vec<&'static str>,
    /// What the base model leaves of every channel.
    pub(super) left_before: Vec<Leftover>,
    /// What the grown one leaves.
    pub(super) left_after: Vec<Leftover>,
}

impl Judged {
    /// Whether every cause of it is one of another, too.
    pub(in crate::diagnosis) fn is_part_of(&self, other: &Self) -> bool {
        let is_there = |id: &str| other.causes.iter().any(|cause| cause.effect == id);
        self.causes.iter().all(|cause| is_there(cause.effect))
    }

    /// What the model leaves for sure, as a share of the motion; nothing counts as explained by
    /// one that does not explain the runs.
    pub(in crate::diagnosis) fn left(&self) -> f64 {
        if self.verdict == Verdict::Unexplained {
            return f64::INFINITY;
        }
        let sure = self.left_after.iter().filter(|left| left.is_sure());
        sure.map(|left| left.share).sum()
    }
}

/// Judges a grown model by what it leaves of the runs that it has grown on.
pub(in crate::diagnosis) fn judged(
    survey: &Survey,
    grown: &Grown,
    reversed: &[Reversed],
) -> Judged {
    let shown = Shown::of(survey, &grown.last.fit);
    let is_untold = |left: &Leftover| !shown.tells(survey, &left.run, left.frequency_rad_s);
    let left_before = leftovers(survey, &grown.base.fit);
    let left_after = leftovers(survey, &grown.last.fit);
    let mut causes = causes(survey, grown);
    let untold_left: Vec<Leftover> =
        left_after.iter().filter(|left| is_untold(left)).cloned().collect();
    // Parts stay in the model, where they keep their share from the causes.
    let parts = causes.split_off(causes.len() - n_parts(&grown.entered, &untold_left));
    let mut suspects: Vec<&'static str> = parts.iter().map(|part| part.effect).collect();
    let is_part = is_part(&left_before, &left_after, &untold_left);
    // What only impossible numbers explain is there all the same.
    let wild = grown.implausible.iter().map(|(_, log)| *log).fold(0.0, f64::max);
    let is_wild = causes.is_empty() && wild > ENTERS_BESIDE;
    // Where the records tell of all that is left, nothing else need be sought.
    let is_left = |left: &[Leftover]| left.iter().any(Leftover::is_structure);
    let is_all_told = is_left(&left_after) && !is_left(&untold_left);
    let untold = is_part || (is_wild || grown.is_unnamed) && !is_all_told;
    if untold {
        suspects.splice(0..0, causes.drain(..).map(|cause| cause.effect));
    }
    causes.extend(shown.causes());
    if survey.runs.iter().any(|run| run.at.kind == RunKind::Forced) {
        causes.extend(reversed::cause(reversed));
    }
    if !causes.iter().any(|cause| cause.effect == wavering::EFFECT)
        && let Some(recorded) =
            wavering::cause(survey.runs.iter().filter_map(|run| run.wavering.as_ref()))
    {
        suspects.retain(|id| *id != recorded.effect);
        causes.push(recorded);
    }
    let verdict = if untold {
        Verdict::Unexplained
    } else if causes.iter().any(|cause| !cause.equivalent_to.is_empty()) {
        Verdict::Ambiguous
    } else if causes.is_empty() {
        Verdict::Adequate
    } else {
        Verdict::Named
    };
    Judged { verdict, causes, suspects, left_before, left_after }
}

fn causes(survey: &Survey, grown: &Grown) -> Vec<Cause> {
    let fit = &grown.last.fit;
    let layout = Layout::new(survey, fit);
    let told = grown.entered.iter().enumerate().map(|(e, entered)| {
        let extension = &fit.extensions[e];
        let mut parameters = Vec::new();
        for (s, values) in extension.slots.iter().enumerate() {
            for (k, value) in values.iter().enumerate() {
                let column = layout.parameter(fit, e, s, k);
                let sd = grown.last.solution.covariance[column][column].max(0.0).sqrt();
                let parameter = extension.effect.parameter(k);
                parameters.push((parameter.symbol, parameter.unit, Estimate::normal(*value, sd)));
            }
        }
        let mut equivalent_to = entered.equivalent_to.clone();
        equivalent_to.extend(extension.effect.always_equivalent);
        let equation = effects::effect(entered.id).map_or("", |effect| effect.equation);
        Cause {
            effect: entered.id,
            equation,
            log_bayes_factor: entered.log_bayes_factor,
            parameters,
            equivalent_to,
        }
    });
    told.collect()
}
