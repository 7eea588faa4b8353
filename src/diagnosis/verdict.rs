//! What is told of a campaign: verdict, causes in order of entry, gain, bias, what is left.

use super::entry::ENTERS_BESIDE;
use super::gain::{self, HeldOut};
use super::growth::{Grown, leftovers};
use super::layout::Layout;
use super::leftover::Leftover;
use super::next_run::{NextRun, next_run};
use super::partial::{is_part, n_parts};
use super::records::Shown;
use super::reversed::{self, Reversed};
use super::settle::Settled;
use super::survey::{N_LAW, Survey};
use super::unexplained::{Unexplained, unexplained};
use super::wavering;
use crate::campaign::Tank;
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

/// One effect of the extended model.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The effect.
    pub effect: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Logarithm of the Bayes factor for adding it [-].
    pub log_bayes_factor: f64,
    /// Parameters: symbol, unit, estimate; the runs or conditions one after the other.
    pub parameters: Vec<(&'static str, &'static str, Estimate)>,
    /// Effects that these runs cannot part from it.
    pub equivalent_to: Vec<&'static str>,
}

/// A figure before and after the extension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Under the base model.
    pub before: Estimate,
    /// Under the extended model.
    pub after: Estimate,
}

/// What the extension gains on runs that took no part in its fit: means over runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gain {
    /// Root mean square error of the predicted roll [deg].
    pub rmse_deg: Change,
    /// Logarithm of the predictive density of a sample, in units of its noise.
    pub log_density: Change,
    /// Share of the moment that is left unexplained [-].
    pub unexplained_share: Change,
    /// Mean over runs of the difference of log densities, with its standard error.
    pub log_density_gain: Estimate,
}

/// What the base model says of the damping, and what the extended one does.
#[derive(Debug, Clone, PartialEq)]
pub struct Bias {
    /// Condition.
    pub condition: String,
    /// Linear damping at rest [1/s].
    pub b1_per_s: Change,
    /// Cubic damping [s].
    pub b3_s: Change,
    /// Speed coefficient [-]; none without runs at different speeds.
    pub kappa: Option<Change>,
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
pub(super) fn told(
    survey: &Survey,
    grown: &Grown,
    reversed: &[Reversed],
    tank: &Tank,
) -> Diagnosis {
    tracing::debug!(spent = survey.n_spent(), "told");
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
        && let Some(recorded) = wavering::cause(survey)
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

fn gain(survey: &Survey, grown: &Grown) -> Option<Gain> {
    let before = gain::held_out(survey, &grown.base, &grown.noise);
    let after = gain::held_out(survey, &grown.last, &grown.noise);
    let is_told = before.iter().chain(&after).all(|held_out| held_out.log_density.is_finite());
    if before.is_empty() || !is_told {
        return None;
    }
    let change = |of: &dyn Fn(&HeldOut) -> f64| Change {
        before: gain::mean(&before.iter().map(of).collect::<Vec<_>>()),
        after: gain::mean(&after.iter().map(of).collect::<Vec<_>>()),
    };
    let differences: Vec<f64> =
        before.iter().zip(&after).map(|(b, a)| a.log_density - b.log_density).collect();
    Some(Gain {
        rmse_deg: change(&|h| h.rmse_rad.to_degrees()),
        log_density: change(&|h| h.log_density),
        unexplained_share: change(&|h| h.unexplained_share),
        log_density_gain: gain::mean(&differences),
    })
}

fn bias(survey: &Survey, grown: &Grown) -> Vec<Bias> {
    let told = survey.conditions.iter().enumerate().map(|(c, condition)| {
        let number = |settled: &Settled, k: usize| {
            let column = N_LAW * c + k;
            let sd = settled.solution.covariance[column][column].max(0.0).sqrt();
            Estimate::normal(settled.fit.laws[c].numbers[k], sd)
        };
        let change =
            |k: usize| Change { before: number(&grown.base, k), after: number(&grown.last, k) };
        let members = survey.members(c);
        let first = survey.runs[members[0]].at.froude;
        let moves = members.iter().any(|r| (survey.runs[*r].at.froude - first).abs() > 1e-3);
        Bias {
            condition: condition.clone(),
            b1_per_s: change(1),
            b3_s: change(3),
            kappa: moves
                .then(|| Change { before: kappa(&grown.base, c), after: kappa(&grown.last, c) }),
        }
    });
    told.collect()
}

/// The ratio `bk/b0` with its deviation to first order.
fn kappa(settled: &Settled, condition: usize) -> Estimate {
    let (zero, slope) = (N_LAW * condition + 1, N_LAW * condition + 2);
    let [_, b0, bk, _] = settled.fit.laws[condition].numbers;
    let covariance = &settled.solution.covariance;
    let kappa = bk / b0;
    let variance = covariance[slope][slope] - 2.0 * kappa * covariance[zero][slope]
        + kappa * kappa * covariance[zero][zero];
    Estimate::normal(kappa, variance.max(0.0).sqrt() / b0.abs())
}

/// The laws, and the effects that were named.
fn model(survey: &Survey, grown: &Grown, causes: &[Cause]) -> ModelFile {
    let named = |id: &str| causes.iter().any(|cause| cause.effect == id);
    // Without named causes the laws are those of the base model.
    let fit = if causes.is_empty() { &grown.base.fit } else { &grown.last.fit };
    let law = |(name, law): (&String, &super::survey::Law)| {
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
