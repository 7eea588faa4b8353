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
    let mut n_steps = 0;
    loop {
        let summaries = survey.summaries(&fit, noise, &|_| Vec::new());
        let (solution, log_evidence) = solve_best(survey, &fit, &summaries);
        let promised = solution.misfit_here - solution.least_misfit;
        let scatter = solution.scatter;
        let here = survey.misfit(&fit, noise) + prior_misfit(survey, &fit, &scatter);
        let own: f64 = summaries.iter().map(|summary| summary.own_gain).sum();
        let total = promised + own + solution.unsettled(survey, &fit);
        if n_steps == MOST_STEPS || total < SMALL_GAIN {
            return Settled { fit, solution, log_evidence, summaries };
        }
        let mut share = 1.0;
        let next = loop {
            let next = moved(survey, &fit, &summaries, &solution, share);
            let there = survey.misfit(&next, noise) + prior_misfit(survey, &next, &scatter);
            if there < here {
                break Some(next);
            }
            share *= 0.4;
            if share < 0.01 {
                break None;
            }
        };
        match next {
            Some(next) => fit = next,
            None => return Settled { fit, solution, log_evidence, summaries },
        }
        n_steps += 1;
    }
}
