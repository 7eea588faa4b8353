//! A record freed of the effects that a campaign's model knows, so that the law alone is left.
//!
//! The run's own numbers are fitted with the effects as the model has them; what the effects add
//! to the readings is then taken off, and the identification sees what the base equation would
//! have read.

use std::sync::Arc;

use super::fit::run_fit::{ChannelNoise, predict};
use super::fit::scatter::Scatter;
use super::fit::solve::followed;
use super::fit::survey::{Extension, Fit, Survey};
use super::record::observation::Observation;
use crate::campaign::Campaign;
use crate::model::effects;
use crate::model::model_file::ModelFile;
use crate::model::{Acts, Scope, Term};
use crate::results::IdentifiedRun;
use crate::run::Run;

/// A run without what a model's effects add to it, and their names.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrected {
    /// The run.
    pub run: Run,
    /// Effects that were taken off.
    pub effects: Vec<&'static str>,
}

/// Steps within which a run's own numbers settle.
const MOST_STEPS: usize = 12;
/// Gain in misfit below which they have.
const SETTLED: f64 = 0.05;
/// The law is no more than a start for a single run.
const LOOSE: Scatter = Scatter { damping: 0.35, frequency: 0.01 };

/// Takes a model's effects off a run; none where no effect of the model acts on it.
///
/// An effect that each run has of its own says nothing about another run and stays.
pub fn corrected(
    identified: &IdentifiedRun,
    campaign: &Campaign,
    model: &ModelFile,
) -> Option<Corrected> {
    let observation = Observation::new(identified, campaign, 0).ok()?;
    let extensions = known(&observation, model);
    if extensions.is_empty() {
        return None;
    }
    let survey = Survey::new(vec![observation], &Arc::default());
    let mut fit = Fit { extensions, ..survey.first_fit() };
    let [sd_rad, sd_n_m] = survey.runs[0].rough_noise;
    let noise = [ChannelNoise { sd: [sd_rad, sd_n_m], correlation: [0.0; 2] }];
    for _ in 0..MOST_STEPS {
        let summaries = survey.summaries(&fit, &noise, &|_| Vec::new());
        let next = followed(&survey, &fit, &summaries, &LOOSE);
        let gain = survey.misfit(&fit, &noise) - survey.misfit(&next, &noise);
        if !gain.is_finite() || gain < SETTLED {
            break;
        }
        fit = next;
    }
    let terms = fit.terms(0);
    let run = without(identified, campaign, &survey.runs[0], &fit, &terms);
    Some(Corrected { run, effects: terms.iter().map(|term| term.effect.id).collect() })
}

/// The effects of a model that act on a run, with the numbers that the model has for it.
fn known(observation: &Observation, model: &ModelFile) -> Vec<Extension> {
    let condition = model.conditions.iter().position(|c| c.name == observation.condition);
    let found = model.effects.iter().filter_map(|known| {
        let effect = effects::effect(&known.id)?;
        let set = match effect.scope {
            Scope::Campaign => known.sets.first()?,
            Scope::Condition => known.sets.get(condition?)?,
            Scope::Run | Scope::OddRun => return None,
        };
        let acts = !matches!(effect.acts, Acts::Record(_)) && (effect.shows)(&observation.at);
        acts.then(|| Extension {
            effect,
            slots: vec![set.clone()],
            centres: vec![set.clone()],
            slot_of: vec![Some(0)],
        })
    });
    found.collect()
}

/// The run's readings less what the effects add.
fn without(
    identified: &IdentifiedRun,
    campaign: &Campaign,
    observation: &Observation,
    fit: &Fit,
    terms: &[Term],
) -> Run {
    let mut run = identified.run.clone();
    let since = |times: &[f64]| -> Vec<f64> {
        times.iter().map(|t| (t - observation.origin_s).max(0.0)).collect()
    };
    let (roll_time_s, moment_time_s) = (since(&run.roll.time_s), since(&run.drive.time_s));
    let n_roll = roll_time_s.len();
    // Every reading as recorded, not as thinned for the fit.
    let whole = Observation { roll_time_s, moment_time_s, ..observation.clone() };
    let with = predict(&whole, &fit.states[0], terms);
    let bare = predict(&whole, &fit.states[0], &[]);
    let added: Vec<f64> = with.iter().zip(&bare).map(|(with, bare)| with - bare).collect();
    for (value, added) in run.roll.value.iter_mut().zip(&added[..n_roll]) {
        *value -= added;
    }
    let rolls = &with[..n_roll];
    let times = &whole.roll_time_s;
    let drive = run.drive.value.iter_mut().zip(&whole.moment_time_s);
    for ((value, time_s), added_n_m) in drive.zip(&added[n_roll..]) {
        let at = times.partition_point(|t| t < time_s).min(n_roll - 1);
        let per_unit = campaign.exciter.as_ref().map_or(1.0, |e| e.moment_n_m(1.0, rolls[at]));
        *value -= added_n_m / per_unit;
    }
    run
}
