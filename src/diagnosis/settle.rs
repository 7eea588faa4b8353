//! Gauss-Newton on all runs together, to the most probable numbers of a model.

use super::run_fit::{ChannelNoise, Summary};
use super::solve::{Solution, followed, moved, prior_misfit, solve_best};
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
    let mut n_steps = 0;
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
            stepped(survey, &fit, &summaries, &solution, noise)
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
fn stepped(
    survey: &Survey,
    fit: &Fit,
    summaries: &[Summary],
    solution: &Solution,
    noise: &[ChannelNoise],
) -> Option<(Fit, Vec<Summary>)> {
    let misfit = |summaries: &[Summary]| summaries.iter().map(|s| s.misfit).sum::<f64>();
    let prior = |fit: &Fit| prior_misfit(survey, fit, &solution.scatter);
    let summarised = |fit: &Fit| survey.summaries(fit, noise, &|_| Vec::new());
    let here = misfit(summaries) + prior(fit);
    // The whole step is nearly always lower, and its summaries are those of the next round.
    let whole = moved(survey, fit, summaries, solution, 1.0);
    let there = summarised(&whole);
    if misfit(&there) + prior(&whole) < here {
        return Some((whole, there));
    }
    let (mut next, mut summarised_next) = (whole, there);
    for _ in 0..FOLLOWING {
        next = followed(survey, &next, &summarised_next, &solution.scatter);
        summarised_next = summarised(&next);
        if misfit(&summarised_next) + prior(&next) < here {
            return Some((next, summarised_next));
        }
    }
    let mut share = 0.4;
    while share >= 0.01 {
        let next = moved(survey, fit, summaries, solution, share);
        if survey.misfit(&next, noise) + prior(&next) < here {
            let there = summarised(&next);
            return Some((next, there));
        }
        share *= 0.4;
    }
    None
}
