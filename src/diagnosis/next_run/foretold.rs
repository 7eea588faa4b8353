//! What runs that the favourite would make are expected to say of its rivals.

use std::sync::Arc;

use super::known::Known;
use super::plan::Plan;
use crate::diagnosis::fit::added::Added;
use crate::diagnosis::fit::run_fit::{ChannelNoise, RunState, Summary, predict, summarise};
use crate::diagnosis::fit::survey::{Fit, Survey, n_values};
use crate::diagnosis::record::observation::Observation;
use crate::diagnosis::search::alike::open_shapes;
use crate::model::{N_BASE, Scope};

/// Times that a rival is linearised anew on runs that it has not seen.
pub(super) const RELINEARISED: usize = 4;

/// What a run that was not made is expected to say of a rival.
pub(super) struct Foretold {
    /// Logarithm of the Bayes factor against it, or that by which its shape is narrowed.
    pub(super) log: f64,
    /// Which of the shapes that the rival may start from in this run comes nearest.
    nearest: usize,
}

/// Runs that a favourite makes.
struct Made<'a> {
    survey: &'a Survey,
    favourite: (&'a str, &'a Known),
    runs: Vec<(RunState, ChannelNoise)>,
    /// The survey with them.
    grown: Survey,
    /// Logarithm by which they change the favourite's own evidence.
    gains: f64,
}

impl<'a> Made<'a> {
    fn new(
        survey: &'a Survey,
        favourite: (&'a str, &'a Known),
        plans: &[(Plan, f64)],
        to_come: [Option<(f64, f64)>; 2],
    ) -> Self {
        let known = favourite.1;
        let mut fit = known.settled.fit.clone();
        let (mut observed, mut runs, mut summaries) = (Vec::new(), Vec::new(), Vec::new());
        for (plan, span_s) in plans {
            let (mut run, state, noise) =
                plan.observed(survey, &known.settled.fit, *span_s, to_come);
            fit = with_run(survey, &fit, &run, state.clone());
            let terms = fit.terms(survey.runs.len() + runs.len());
            let readings = predict(&run, &state, &terms);
            let (roll, moment) = readings.split_at(run.roll_time_s.len());
            (run.roll_rad, run.moment_n_m) = (roll.to_vec(), moment.to_vec());
            summaries.push(summarise(&run, &state, &terms, &[], &noise, None));
            observed.push(run);
            runs.push((state, noise));
        }
        let grown = grown_survey(survey, observed);
        let gains = known.gains(&grown, &fit, &summaries);
        Self { survey, favourite, runs, grown, gains }
    }

    /// A rival's fit with the run at a place among these, from each of the shapes that it may start
    /// from there.
    fn starts(&self, rival: &Fit, place: usize) -> Vec<Fit> {
        let run = &self.grown.runs[self.survey.runs.len() + place];
        let [w, b1, b3] = rival.laws[self.survey.condition_of[0]].at(run.at.froude);
        let mut guess = self.runs[place].0.clone();
        (guess.base.natural_rad_s, guess.base.b1_per_s, guess.base.b3_s) = (w, b1, b3);
        guess.base.log_scale = rival.log_scale;
        with_own_set(with_run(self.survey, rival, run, guess), run)
    }

    /// What they say of a rival that comes so near.
    fn said(&self, rival: &Known, answer: &Answer) -> f64 {
        let (id, _) = self.favourite;
        if let Some((_, shapes)) = open_shapes(self.survey, &rival.settled.fit, id) {
            // Where the rival is the favourite with its shape left open, nothing but that shape
            // parts them.
            let before = &rival.settled.solution.covariance;
            let after = answer.added.eliminated.covariance();
            let gains = shapes.iter().map(|(_, c)| 0.5 * (before[*c][*c] / after[*c][*c]).ln());
            return gains.fold(f64::INFINITY, f64::min);
        }
        (self.gains - rival.gains(&self.grown, &answer.fit, &answer.summaries)).max(0.0)
    }
}

/// A survey with runs that were not made; what they cost is counted with the others.
pub(super) fn grown_survey(survey: &Survey, runs: Vec<Observation>) -> Survey {
    let mut grown = Survey {
        runs: survey.runs.clone(),
        conditions: survey.conditions.clone(),
        condition_of: survey.condition_of.clone(),
        cost: survey.cost.unlimited(),
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

/// What a run is expected to say of each rival of a favourite that makes it.
pub(super) fn foretold(
    survey: &Survey,
    favourite: (&str, &Known),
    rivals: &[&Known],
    plan: (Plan, f64),
    to_come: [Option<(f64, f64)>; 2],
) -> Vec<Foretold> {
    let made = Made::new(survey, favourite, &[plan], to_come);
    let of_rival = |rival: &&Known| {
        let starts = made.starts(&rival.settled.fit, 0);
        // Of the shapes the nearest is found in one round, as a score finds it.
        let left: Vec<f64> = match starts.len() {
            1 => vec![0.0],
            _ => starts.iter().map(|s| answer(&made, rival, s, 1).added.least_misfit()).collect(),
        };
        let nearest = (0..left.len()).min_by(|a, b| left[*a].total_cmp(&left[*b])).unwrap_or(0);
        let answer = answer(&made, rival, &starts[nearest], RELINEARISED);
        Foretold { log: made.said(rival, &answer), nearest }
    };
    rivals.iter().map(of_rival).collect()
}

/// What two runs together are expected to say of the rival that is hardest to part: one that each
/// run has of its own starts from the shape that came nearest in each alone, for of couples of
/// shapes there are too many to try. The rivals are linearised so many times.
pub(super) fn foretold_together(
    survey: &Survey,
    favourite: (&str, &Known),
    rivals: &[&Known],
    plans: [(Plan, f64); 2],
    alone: [&[Foretold]; 2],
    to_come: [Option<(f64, f64)>; 2],
    rounds: usize,
) -> f64 {
    let made = Made::new(survey, favourite, &plans, to_come);
    let of_rival = |(k, rival): (usize, &&Known)| {
        let mut start = rival.settled.fit.clone();
        for (place, alone) in alone.iter().enumerate() {
            start = made.starts(&start, place).swap_remove(alone[k].nearest);
        }
        made.said(rival, &answer(&made, rival, &start, rounds))
    };
    rivals.iter().enumerate().map(of_rival).fold(f64::INFINITY, f64::min)
}

/// A rival's answer to runs that it has not made.
struct Answer {
    added: Added,
    fit: Fit,
    summaries: Vec<Summary>,
}

/// The rival's answer with all its numbers, as far as the runs so far let it, linearised anew so
/// many times.
fn answer(made: &Made, rival: &Known, start: &Fit, rounds: usize) -> Answer {
    let (survey, grown) = (made.survey, &made.grown);
    let (known, scatter) = (&rival.settled.fit, &rival.settled.solution.scatter);
    let mut fit = start.clone();
    // Where the added runs are linearised; the others stay where they were.
    let mut extensions = fit.extensions.clone();
    let mut round = 0;
    loop {
        round += 1;
        let there = Fit { extensions: extensions.clone(), ..fit.clone() };
        let summaries: Vec<_> = (survey.runs.len()..grown.runs.len())
            .zip(&made.runs)
            .map(|(r, (_, noise))| {
                let (now, then) = (there.terms(r), fit.terms(r));
                let state = &fit.states[r];
                grown.spend(r, &now, state.own.len() + N_BASE + n_values(&now));
                let mut summary = summarise(&grown.runs[r], state, &now, &[], noise, None);
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
            return Answer { added, fit, summaries };
        }
        let (moved, states) = added.moved(grown, &fit, &summaries);
        extensions = moved;
        fit.states.truncate(survey.runs.len());
        fit.states.extend(states);
    }
}
