//! Gauss-Newton on all runs together, to the most probable numbers of a model.

use super::run_fit::{ChannelNoise, Summary};
use super::solve::{Solution, moved, prior_misfit, solve_best};
use super::survey::{Fit, Survey};

/// A model at its most probable numbers.
pub(super) struct Settled {
    pub(super) fit: Fit,
    pub(super) solution: Solution,
    /// Logarithm of the evidence over all scatters.
    pub(super) log_evidence: f64,
    pub(super) summaries: Vec<Summary>,
}

/// Steps after which a model that still moves is taken where it is.
const MOST_STEPS: usize = 12;
/// Promised gain in misfit below which a fit has settled.
const SMALL_GAIN: f64 = 0.05;

/// Settles a model from where it stands.
pub(super) fn settle(survey: &Survey, start: Fit, noise: &[ChannelNoise]) -> Settled {
    let mut fit = start;
    let mut summaries = survey.summaries(&fit, noise, &|_| Vec::new());
    let mut n_steps = 0;
    loop {
        let (solution, log_evidence) = solve_best(survey, &fit, &summaries);
        let promised = solution.misfit_here - solution.least_misfit;
        let own: f64 = summaries.iter().map(|summary| summary.own_gain).sum();
        let total = promised + own + solution.unsettled(survey, &fit);
        if n_steps == MOST_STEPS || total < SMALL_GAIN {
            return Settled { fit, solution, log_evidence, summaries };
        }
        match stepped(survey, &fit, &summaries, &solution, noise) {
            Some(better) => (fit, summaries) = better,
            None => return Settled { fit, solution, log_evidence, summaries },
        }
        n_steps += 1;
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
