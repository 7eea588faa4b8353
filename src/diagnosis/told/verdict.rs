//! What is told of a campaign: verdict, causes in order of entry, gain, bias, what is left.

use super::bias::{Bias, bias};
use super::gain::{Gain, gain};
use super::partial::{is_part, n_parts};
use super::unexplained::{Unexplained, unexplained};
use crate::campaign::Tank;
use crate::diagnosis::cause::Cause;
use crate::diagnosis::fit::layout::Layout;
use crate::diagnosis::fit::leftover::{Leftover, leftovers};
use crate::diagnosis::fit::survey::{Law, Survey};
use crate::diagnosis::next_run::most_telling::{NextRun, next_run};
use crate::diagnosis::record::reversed::{self, Reversed};
use crate::diagnosis::record::wavering;
use crate::diagnosis::search::entry::ENTERS_BESIDE;
use crate::diagnosis::search::growth::Grown;
use crate::diagnosis::shown::Shown;
use crate::inverse::estimate::Estimate;
use crate::model::effects;
use crate::model::model_file::{ConditionModel, EffectModel, ModelFile};
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

/// What a grown model says of the runs that it has grown on.
pub(in crate::diagnosis) fn told(
    survey: &Survey,
    grown: &Grown,
    reversed: &[Reversed],
    tank: &Tank,
) -> Diagnosis {
    tracing::debug!(spent = survey.cost.n_spent(), "told");
    if grown.is_cut_short {
        tracing::warn!("the search for causes was cut short; hint: diagnose fewer runs together");
    }
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
    let next_run = next_run(survey, grown, tank);
    let model = model(survey, grown, &causes);
    let mut implausible: Vec<&'static str> = Vec::new();
    for (id, _) in &grown.implausible {
        if !implausible.contains(id) {
            implausible.push(id);
        }
    }
    Diagnosis {
        verdict,
        causes,
        suspects,
        implausible,
        cut_short: grown.is_cut_short,
        gain: gain(survey, grown),
        bias: bias(survey, grown),
        ranking: grown.ranking.clone(),
        left_before,
        left_after,
        unexplained_before: unexplained(survey, &grown.base.fit),
        unexplained_after: unexplained(survey, &grown.last.fit),
        next_run,
        model,
    }
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
