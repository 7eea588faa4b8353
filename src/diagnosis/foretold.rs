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
use super::survey::{Fit, Survey, n_values};
use crate::model::{N_BASE, Scope};

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

/// What a run that was not made is expected to say.
pub(super) struct Foretold {
    /// Half of the misfit that the rival would keep, or the logarithm by which its shape is
    /// narrowed.
    pub(super) log: f64,
    /// Which of the shapes that the rival may start from in this run comes nearest.
    nearest: usize,
}

/// A run that the favourite makes, and where a rival starts in it.
struct Made {
    run: Observation,
    guess: RunState,
    noise: ChannelNoise,
}

impl Made {
    fn new(
        survey: &Survey,
        favourite: &Fit,
        rival: &Fit,
        (plan, span_s): (Plan, f64),
        to_come: [Option<(f64, f64)>; 2],
    ) -> Self {
        let (mut run, state, noise) = plan.observed(survey, favourite, span_s, to_come);
        let truth = with_run(survey, favourite, &run, state.clone());
        let readings = predict(&run, &state, &truth.terms(survey.runs.len()));
        let (roll, moment) = readings.split_at(run.roll_time_s.len());
        (run.roll_rad, run.moment_n_m) = (roll.to_vec(), moment.to_vec());
        let law = rival.laws[survey.condition_of[0]].at(plan.froude);
        let mut guess = state;
        (guess.base.natural_rad_s, guess.base.b1_per_s, guess.base.b3_s) = (law[0], law[1], law[2]);
        guess.base.log_scale = rival.log_scale;
        Self { run, guess, noise }
    }

    /// The rival's fit with this run, from each of the shapes that it may start from there.
    fn starts(&self, survey: &Survey, rival: &Fit) -> Vec<Fit> {
        with_own_set(with_run(survey, rival, &self.run, self.guess.clone()), &self.run)
    }
}

/// A survey with runs that were not made; what they cost is counted with the others.
pub(super) fn grown_survey(survey: &Survey, runs: Vec<Observation>) -> Survey {
    let mut grown = Survey {
        runs: survey.runs.clone(),
        conditions: survey.conditions.clone(),
        condition_of: survey.condition_of.clone(),
        spent: Arc::clone(&survey.spent),
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
    let nodes = (effect.nodes)(&run.at);
    if nodes.is_empty() { vec![fit] } else { nodes.into_iter().map(started).collect() }
}

/// What a run is expected to say between a favourite, which makes it, and a rival.
pub(super) fn foretold(
    survey: &Survey,
    (id, favourite): (&str, &Fit),
    rival: &Rival,
    plan: (Plan, f64),
    to_come: [Option<(f64, f64)>; 2],
) -> Foretold {
    let made = Made::new(survey, favourite, &rival.settled.fit, plan, to_come);
    let starts = made.starts(survey, &rival.settled.fit);
    let grown = grown_survey(survey, vec![made.run]);
    let answer =
        |k: usize, rounds| answered(survey, &grown, rival, &starts[k], &[made.noise], rounds);
    // Of the shapes the nearest is found in one round, as a score finds it.
    let left: Vec<f64> = match starts.len() {
        1 => vec![0.0],
        n => (0..n).map(|k| answer(k, 1).least_misfit()).collect(),
    };
    let nearest = (0..left.len()).min_by(|a, b| left[*a].total_cmp(&left[*b])).unwrap_or(0);
    Foretold { log: said(survey, id, rival, &answer(nearest, RELINEARISED)), nearest }
}

/// The same of two runs together: a rival that each run has of its own starts from the shape that
/// came nearest in each alone, for of couples of shapes there are too many to try.
pub(super) fn foretold_together(
    survey: &Survey,
    (id, favourite): (&str, &Fit),
    rival: &Rival,
    plans: [(Plan, f64); 2],
    alone: [&Foretold; 2],
    to_come: [Option<(f64, f64)>; 2],
) -> f64 {
    let mut start = rival.settled.fit.clone();
    let made = plans.map(|plan| Made::new(survey, favourite, &start, plan, to_come));
    for (made, alone) in made.iter().zip(alone) {
        start = made.starts(survey, &start).swap_remove(alone.nearest);
    }
    let noises = [made[0].noise, made[1].noise];
    let grown = grown_survey(survey, made.map(|made| made.run).to_vec());
    said(survey, id, rival, &answered(survey, &grown, rival, &start, &noises, RELINEARISED))
}

/// Half of the misfit that a rival keeps on added runs, or the logarithm by which they narrow its
/// shape.
fn said(survey: &Survey, favourite: &str, rival: &Rival, answer: &Added) -> f64 {
    if let Some((_, shapes)) = open_shapes(survey, &rival.settled.fit, favourite) {
        // Where the rival is the favourite with its shape left open, nothing but that shape parts
        // them.
        let (before, after) = (&rival.settled.solution.covariance, answer.eliminated.covariance());
        let gains = shapes.iter().map(|(_, c)| 0.5 * (before[*c][*c] / after[*c][*c]).ln());
        return gains.fold(f64::INFINITY, f64::min);
    }
    0.5 * (answer.least_misfit() - rival.least_misfit).max(0.0)
}

/// The rival's answer to the added runs with all its numbers, as far as the runs so far let it,
/// linearised anew so many times.
fn answered(
    survey: &Survey,
    grown: &Survey,
    rival: &Rival,
    start: &Fit,
    noises: &[ChannelNoise],
    rounds: usize,
) -> Added {
    let (known, scatter) = (&rival.settled.fit, &rival.settled.solution.scatter);
    let mut fit = start.clone();
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
                grown.spend(r, &now, state.own.len() + N_BASE + n_values(&now));
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
        if round == rounds {
            return added;
        }
        let (moved, states) = added.moved(grown, &fit, &summaries);
        extensions = moved;
        fit.states.truncate(survey.runs.len());
        fit.states.extend(states);
    }
}
