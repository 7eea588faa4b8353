//! What is told of a campaign: verdict, causes in order of entry, gain, bias, what is left.

use super::bias::{Bias, bias};
use super::gain::{Gain, gain};
use super::unexplained::{Unexplained, unexplained};
use super::verdict::{Judged, Verdict};
use crate::campaign::Tank;
use crate::diagnosis::cause::Cause;
use crate::diagnosis::fit::leftover::Leftover;
use crate::diagnosis::fit::survey::{Law, Survey};
use crate::diagnosis::next_run::most_telling::{NextRun, next_run};
use crate::diagnosis::search::growth::Grown;
use crate::model::model_file::{ConditionModel, EffectModel, ModelFile};

/// What a campaign's runs say about the simulation model.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Verdict,
    /// Causes in order of entry.
    pub causes: Vec<Cause>,
    /// Effects that explain a part of what they found, most of which remains unexplained.
    pub suspects: Vec<&'static str>,
    /// Effects that would explain something only with impossible numbers.
    pub implausible: Vec<&'static str>,
    /// Whether the search for causes ended at what it may cost.
    pub cut_short: bool,
    /// Every effect with the logarithm of its Bayes factor against the base model, best first.
    pub ranking: Vec<(&'static str, f64)>,
    /// Gain on runs held out; none with a single run.
    pub gain: Option<Gain>,
    /// One per condition.
    pub bias: Vec<Bias>,
    /// What the base model leaves of every channel.
    pub left_before: Vec<Leftover>,
    /// What the extended model leaves.
    pub left_after: Vec<Leftover>,
    /// The moment that the base model leaves in every run.
    pub unexplained_before: Vec<Unexplained>,
    /// The moment that the extended model leaves.
    pub unexplained_after: Vec<Unexplained>,
    /// What to tow next.
    pub next_run: Option<NextRun>,
    /// The extended model.
    pub model: ModelFile,
}

impl Diagnosis {
    /// Lets go of what only its own page shows, instant by instant.
    pub fn forget_moments(&mut self) {
        (self.unexplained_before, self.unexplained_after) = (Vec::new(), Vec::new());
    }
}

/// All that a grown model, as it is judged, says of the runs that it has grown on.
pub(in crate::diagnosis) fn told(
    survey: &Survey,
    grown: Grown,
    judged: Judged,
    tank: &Tank,
) -> Diagnosis {
    tracing::debug!(spent = survey.cost.n_spent(), "told");
    if grown.is_cut_short {
        tracing::warn!("the search for causes was cut short; hint: diagnose fewer runs together");
    }
    survey.cost.begin();
    let next_run = next_run(survey, &grown, tank);
    let model = model(survey, &grown, &judged.causes);
    let mut implausible: Vec<&'static str> = Vec::new();
    for (id, _) in &grown.implausible {
        if !implausible.contains(id) {
            implausible.push(id);
        }
    }
    let unexplained_before = unexplained(survey, &grown.base.fit);
    let unexplained_after = if grown.is_base() {
        unexplained_before.clone()
    } else {
        unexplained(survey, &grown.last.fit)
    };
    Diagnosis {
        verdict: judged.verdict,
        causes: judged.causes,
        suspects: judged.suspects,
        implausible,
        cut_short: grown.is_cut_short,
        gain: gain(survey, &grown),
        bias: bias(survey, &grown),
        ranking: grown.ranking,
        left_before: judged.left_before,
        left_after: judged.left_after,
        unexplained_before,
        unexplained_after,
        next_run,
        model,
    }
}

/// The laws, and the effects that were named.
fn model(survey: &Survey, grown: &Grown, causes: &[Cause]) -> ModelFile {
    let named = |id: &str| causes.iter().any(|cause| cause.effect == id);
    // Without named causes the laws are those of the base model.
    let fit = if causes.is_empty() { &grown.base.fit } else { &grown.last.fit };
    let law = |(name, law): (&String, &Law)| {
        let [natural_frequency_rad_s, b0_per_s, bk, b3_s] = law.numbers;
        let kappa = bk / b0_per_s;
        ConditionModel { name: name.clone(), natural_frequency_rad_s, b0_per_s, kappa, b3_s }
    };
    let conditions = survey.conditions.iter().zip(&fit.laws).map(law).collect();
    let effects = fit
        .extensions
        .iter()
        .filter(|extension| named(extension.effect.id))
        .map(|extension| EffectModel {
            id: extension.effect.id.to_owned(),
            sets: extension.slots.clone(),
        })
        .collect();
    ModelFile { conditions, effects }
}
