//! What a rival is expected to leave of runs that the favourite would make.

use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use super::added::Added;
use super::alike::open_shapes;
use super::elimination::Products;
use super::observation::Observation;
use super::plan::Plan;
use super::run_fit::{ChannelNoise, RunState, predict, summarise};
use super::settle::Settled;
use super::solve::Joint;
use super::survey::{Fit, Survey};
use crate::model::Scope;

/// Times that a rival is linearised anew on runs that it has not seen.
const RELINEARISED: usize = 4;

/// A rival with all that the runs so far say of it.
pub(super) struct Rival {
    pub(super) settled: Settled,
    /// The runs so far under its scatter.
    products: Products,
    /// What they leave.
    least_misfit: f64,
}

impl Rival {
    pub(super) fn new(survey: &Survey, settled: Settled) -> Self {
        let joint = Joint::new(survey, &settled.fit, &settled.summaries);
        let (_, products) = joint.gathered(&settled.solution.scatter);
        let least_misfit = settled.solution.least_misfit;
        Self { settled, products, least_misfit }
    }
}

/// A survey with runs that were not made.
pub(super) fn grown_survey(survey: &Survey, runs: Vec<Observation>) -> Survey {
    let mut grown = Survey {
        runs: survey.runs.clone(),
        conditions: survey.conditions.clone(),
        condition_of: survey.condition_of.clone(),
        spent: Arc::default(),
        until: AtomicU64::new(u64::MAX),
    };
    for run in runs {
        grown.runs.push(Arc::new(run));
        grown.condition_of.push(survey.condition_of[0]);
    }
    grown
}

/// The fit with the set of each extension that a new run would have, and where that stands.
pub(super) fn with_run(survey: &Survey, fit: &Fit, run: &Observation, state: RunState) -> Fit {
    let mut fit = fit.clone();
    for extension in &mut fit.extensions {
        let slot = match extension.effect.scope {
            Scope::Campaign => Some(0),
            Scope::Condition => Some(survey.condition_of[0]),
            Scope::Run | Scope::OddRun => None,
        };
        extension.slot_of.push(slot.filter(|_| (extension.effect.shows)(&run.at)));
    }
    fit.states.push(state);
    fit
}

/// The fit after its newest effect, which each run has of its own, has got a set in the last run;
/// one for each of the shapes to start from. Others have all sets that they need.
fn with_own_set(fit: Fit, run: &Observation) -> Vec<Fit> {
    let Some(newest) = fit.extensions.last() else { return vec![fit] };
    let effect = newest.effect;
    if !effect.scope.is_of_each_run() || !(effect.shows)(&run.at) {
        return vec![fit];
    }
    let started = |shape: Vec<f64>| {
        let mut fit = fit.clone();
        if let Some(newest) = fit.extensions.last_mut() {
            let mut values = vec![0.0; effect.strengths.len()];
            values.extend(shape);
            let slot = Some(newest.slots.len());
            newest.slot_of.last_mut().into_iter().for_each(|of_run| *of_run = slot);
            newest.centres.push(values.clone());
            newest.slots.push(values);
        }
        fit
    };
    (effect.nodes)(&run.at).into_iter().map(started).collect()
}

/// Half of the misfit that a rival would keep on runs that the favourite made, or the logarithm
/// by which the runs narrow the rival's shape.
pub(super) fn expected_log_bayes_factor(
    survey: &Survey,
    (favourite_id, favourite): (&str, &Fit),
    rival: &Rival,
    plans: &[(Plan, f64)],
    to_come: [Option<(f64, f64)>; 2],
) -> f64 {
    let known = &rival.settled.fit;
    let (mut runs, mut noises) = (Vec::new(), Vec::new());
    let mut starts = vec![known.clone()];
    for (plan, span_s) in plans {
        let (mut run, state, noise) = plan.observed(survey, favourite, *span_s, to_come);
        let truth = with_run(survey, favourite, &run, state.clone());
        let readings = predict(&run, &state, &truth.terms(survey.runs.len()));
        let (roll, moment) = readings.split_at(run.roll_time_s.len());
        (run.roll_rad, run.moment_n_m) = (roll.to_vec(), moment.to_vec());
        let law = known.laws[survey.condition_of[0]].at(plan.froude);
        let mut guess = state;
        (guess.base.natural_rad_s, guess.base.b1_per_s, guess.base.b3_s) = (law[0], law[1], law[2]);
        guess.base.log_scale = known.log_scale;
        let with_it = |fit: &Fit| with_own_set(with_run(survey, fit, &run, guess.clone()), &run);
        starts = starts.iter().flat_map(with_it).collect();
        runs.push(run);
        noises.push(noise);
    }
    let grown = grown_survey(survey, runs);
    let best = starts
        .into_iter()
        .map(|start| answered(survey, &grown, rival, start, &noises))
        .min_by(|a, b| a.least_misfit().total_cmp(&b.least_misfit()));
    let Some(best) = best else { return 0.0 };
    if let Some((_, shapes)) = open_shapes(survey, known, favourite_id) {
        // Where the rival is the favourite with its shape left open, nothing but that shape parts
        // them.
        let (before, after) = (&rival.settled.solution.covariance, best.eliminated.covariance());
        let gains = shapes.iter().map(|(_, c)| 0.5 * (before[*c][*c] / after[*c][*c]).ln());
        return gains.fold(f64::INFINITY, f64::min);
    }
    0.5 * (best.least_misfit() - rival.least_misfit).max(0.0)
}

/// The rival's answer to the added runs with all its numbers, as far as the runs so far let it.
fn answered(
    survey: &Survey,
    grown: &Survey,
    rival: &Rival,
    start: Fit,
    noises: &[ChannelNoise],
) -> Added {
    let (known, scatter) = (&rival.settled.fit, &rival.settled.solution.scatter);
    let mut fit = start;
    // Where the added runs are linearised; the others stay where they were.
    let mut extensions = fit.extensions.clone();
    let mut round = 0;
    loop {
        round += 1;
        let there = Fit { extensions: extensions.clone(), ..fit.clone() };
        let summaries: Vec<_> = (survey.runs.len()..grown.runs.len())
            .zip(noises)
            .map(|(r, noise)| {
                let (now, then) = (there.terms(r), fit.terms(r));
                let state = &fit.states[r];
                let mut summary = summarise(&grown.runs[r], state, &now, &[], noise);
                let mut moved_by = vec![state.base.log_scale - fit.log_scale];
                for (now, then) in now.iter().zip(&then) {
                    moved_by.extend(now.values.iter().zip(&then.values).map(|(n, t)| n - t));
                }
                summary.refer_back(&moved_by);
                summary
            })
            .collect();
        let added = Added::new((known, &rival.products), grown, &fit, &summaries, scatter);
        if round == RELINEARISED {
            return added;
        }
        let (moved, states) = added.moved(grown, &fit, &summaries);
        extensions = moved;
        fit.states.truncate(survey.runs.len());
        fit.states.extend(states);
    }
}
