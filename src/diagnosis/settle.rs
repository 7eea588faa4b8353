//! Gauss-Newton on all runs together, to the most probable numbers of a model.

use super::run_fit::{ChannelNoise, Summary};
use super::solve::{Solution, followed, moved, prior_misfit, solve, solve_best};
use super::survey::{Fit, Survey};

/// A model at its most probable numbers.
#[derive(Clone)]
pub(super) struct Settled {
    pub(super) fit: Fit,
    pub(super) solution: Solution,
    /// Logarithm of the evidence over all scatters.
    pub(super) log_evidence: f64,
    pub(super) summaries: Vec<Summary>,
    /// Misfit that it is still promised to lose; that much is not in the evidence.
    pub(super) promised: f64,
}

/// Steps after which a model that still moves is taken where it is.
const MOST_STEPS: usize = 12;
/// The same of a model that may yet be the best.
const MOST_STEPS_MORE: usize = 12;
/// Steps that the runs' own numbers are given to follow a step of the campaign's.
const FOLLOWING: usize = 3;
/// What they may still gain by it when the campaign steps again.
const UNFOLLOWED: f64 = 1.0;
/// Promised gain in misfit below which a fit has settled.
const SMALL_GAIN: f64 = 0.05;

/// Factor between shares of a step that are tried, and the least of them.
const SMALLER: f64 = 0.3;
const LEAST_SHARE: f64 = 0.008;
/// Share of a step over which it is seen how the readings bend.
const LITTLE: f64 = 0.1;

/// Settles a model from where it stands.
pub(super) fn settle(survey: &Survey, start: Fit, noise: &[ChannelNoise]) -> Settled {
    settle_in(MOST_STEPS, survey, start, noise)
}

/// Settles a model further that has not settled in the steps that any is given.
pub(super) fn settle_further(survey: &Survey, start: Fit, noise: &[ChannelNoise]) -> Settled {
    settle_in(MOST_STEPS_MORE, survey, start, noise)
}

fn settle_in(most_steps: usize, survey: &Survey, start: Fit, noise: &[ChannelNoise]) -> Settled {
    let mut fit = start;
    let mut summaries = survey.summaries(&fit, noise, &|_| Vec::new());
    let (mut n_steps, mut share) = (0, 1.0);
    let (mut n_followed, mut misfit_before) = (0, f64::INFINITY);
    loop {
        let (solution, log_evidence) = solve_best(survey, &fit, &summaries);
        let promised = solution.misfit_here - solution.least_misfit;
        let own: f64 = summaries.iter().map(|summary| summary.own_gain).sum();
        let unfollowed = own + solution.unsettled(survey, &fit);
        if promised + unfollowed < SMALL_GAIN {
            return Settled { fit, solution, log_evidence, summaries, promised: 0.0 };
        }
        // A long record bends the valley: the runs' own numbers follow what the campaign's did
        // before it steps again, while that brings them lower.
        let still_falls = misfit_before - solution.misfit_here > SMALL_GAIN;
        if n_steps > 0 && unfollowed > UNFOLLOWED && n_followed < FOLLOWING && still_falls {
            misfit_before = solution.misfit_here;
            fit = followed(survey, &fit, &summaries, &solution.scatter);
            summaries = survey.summaries(&fit, noise, &|_| Vec::new());
            n_followed += 1;
            continue;
        }
        let better = if n_steps < most_steps {
            stepped(survey, &fit, &summaries, &solution, noise, &mut share)
        } else {
            None
        };
        let Some(better) = better else {
            // What is promised to a fit that gets no further is no evidence for it.
            let log_evidence = log_evidence - 0.5 * promised;
            return Settled { fit, solution, log_evidence, summaries, promised };
        };
        (fit, summaries) = better;
        (n_steps, n_followed, misfit_before) = (n_steps + 1, 0, f64::INFINITY);
    }
}

/// A fit that lies lower along the solution's step, summarised; none where there is none.
///
/// What is left of a long record turns with every phase that it has run up, so that a step along
/// what changes at its start soon leaves the valley. Where the whole step does, the readings are
/// followed to the second order, for ever smaller shares of it (geodesic acceleration: Transtrum
/// and Sethna 2012, arXiv:1201.5885).
fn stepped(
    survey: &Survey,
    fit: &Fit,
    summaries: &[Summary],
    solution: &Solution,
    noise: &[ChannelNoise],
    share: &mut f64,
) -> Option<(Fit, Vec<Summary>)> {
    let misfit = |summaries: &[Summary]| summaries.iter().map(|s| s.misfit).sum::<f64>();
    let prior = |fit: &Fit| prior_misfit(survey, fit, &solution.scatter);
    let here = misfit(summaries) + prior(fit);
    let is_lower = |next: &Fit| survey.misfit(next, noise) + prior(next) < here;
    let summarised = |fit: &Fit| survey.summaries(fit, noise, &|_| Vec::new());
    let whole = moved(survey, fit, summaries, solution, 1.0);
    if *share < 1.0 {
        if is_lower(&whole) {
            *share = 1.0;
            let there = summarised(&whole);
            return Some((whole, there));
        }
    } else {
        // It is nearly always lower, and its summaries are those of the next round.
        let there = summarised(&whole);
        if misfit(&there) + prior(&whole) < here {
            return Some((whole, there));
        }
    }
    let bends = bends(survey, fit, summaries, solution);
    *share = (*share / SMALLER).min(1.0);
    while *share >= LEAST_SHARE {
        let along = survey.summaries_less(fit, noise, &bends, *share);
        let curved = solve(survey, fit, &along, solution.scatter);
        let next = moved(survey, fit, &along, &curved, *share);
        if is_lower(&next) {
            let there = summarised(&next);
            return Some((next, there));
        }
        *share *= SMALLER;
    }
    None
}

/// What the readings of every run bend away by along the whole of a solution's step.
fn bends(survey: &Survey, fit: &Fit, summaries: &[Summary], solution: &Solution) -> Vec<Vec<f64>> {
    let by = |share: f64| moved(survey, fit, summaries, solution, share);
    let (back, on) = (by(-LITTLE), by(LITTLE));
    survey.each_run(&|run| {
        let readings = |fit: &Fit| survey.readings(fit, run);
        let (back, here, on) = (readings(&back), readings(fit), readings(&on));
        let bend = |((back, here), on)| 0.5 * (back + on - 2.0 * here) / (LITTLE * LITTLE);
        back.iter().zip(&here).zip(&on).map(bend).collect()
    })
}
