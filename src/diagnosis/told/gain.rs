//! What the extension gains on runs that took no part in its fit.

use super::change::Change;
use crate::diagnosis::fit::run_fit::{
    ChannelNoise, RunState, Summary, predict, residual, summarise,
};
use crate::diagnosis::fit::settle::Settled;
use crate::diagnosis::fit::solve::{moved, solve};
use crate::diagnosis::fit::survey::{Fit, Survey};
use crate::diagnosis::search::growth::Grown;
use crate::inverse::estimate::Estimate;

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

/// The gain of a grown model over its base; none where no run can be held out.
pub(super) fn gain(survey: &Survey, grown: &Grown) -> Option<Gain> {
    let before = held_out(survey, &grown.base, &grown.noise);
    let after = held_out(survey, &grown.last, &grown.noise);
    let is_told = before.iter().chain(&after).all(|held_out| held_out.log_density.is_finite());
    if before.is_empty() || !is_told {
        return None;
    }
    let change = |of: &dyn Fn(&HeldOut) -> f64| Change {
        before: mean(&before.iter().map(of).collect::<Vec<_>>()),
        after: mean(&after.iter().map(of).collect::<Vec<_>>()),
    };
    let differences: Vec<f64> =
        before.iter().zip(&after).map(|(b, a)| a.log_density - b.log_density).collect();
    Some(Gain {
        rmse_deg: change(&|h| h.rmse_rad.to_degrees()),
        log_density: change(&|h| h.log_density),
        unexplained_share: change(&|h| h.unexplained_share),
        log_density_gain: mean(&differences),
    })
}

/// One run predicted by a model that never saw it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct HeldOut {
    /// Root mean square of measured less predicted roll [rad].
    rmse_rad: f64,
    /// Mean logarithm of the predictive density of a sample of either channel, in units of its
    /// noise.
    log_density: f64,
    /// Share of the moment's energy that is left unexplained [-].
    unexplained_share: f64,
}

/// Every run predicted without its own help; nothing when there is one run.
///
/// Only the start of a run (its initial state, or the course that the rod imposed) is its own, and
/// what it rolled tells that: the moment is to be foretold.
fn held_out(survey: &Survey, settled: &Settled, noise: &[ChannelNoise]) -> Vec<HeldOut> {
    if survey.runs.len() < 2 {
        return Vec::new();
    }
    survey.each_run(&|run| {
        let trained = without(survey, settled, run);
        predicted(survey, &trained, run, &noise[run])
    })
}

/// The fit without one run: its readings count nothing.
fn without(survey: &Survey, settled: &Settled, run: usize) -> Fit {
    let mut summaries: Vec<Summary> = settled.summaries.clone();
    summaries[run] = summaries[run].emptied();
    let solution = solve(survey, &settled.fit, &summaries, settled.solution.scatter);
    moved(survey, &settled.fit, &summaries, &solution, 1.0)
}

fn predicted(survey: &Survey, trained: &Fit, run: usize, noise: &ChannelNoise) -> HeldOut {
    let observation = &survey.runs[run];
    let terms = trained.terms(run);
    let law = trained.laws[survey.condition_of[run]].at(observation.at.froude);
    let mut state =
        RunState { own: trained.states[run].own.clone(), ..trained.states[run].clone() };
    (state.base.natural_rad_s, state.base.b1_per_s, state.base.b3_s) = (law[0], law[1], law[2]);
    state.base.log_scale = trained.log_scale;
    let rolled = ChannelNoise { sd: [noise.sd[0], f64::INFINITY], correlation: [0.0; 2] };
    for _ in 0..3 {
        let own = summarise(observation, &state, &terms, &[], &rolled, None);
        let nothing = vec![0.0; own.eliminated.rest.n() - 1];
        let steps = own.eliminated.back(&nothing);
        state.own.resize(steps.len(), 0.0);
        state.own.iter_mut().zip(&steps).for_each(|(number, step)| *number += step);
    }
    let left = residual(observation, &predict(observation, &state, &terms));
    let n_roll = observation.roll_rad.len();
    let mean_square =
        |part: &[f64]| part.iter().map(|r| r * r).sum::<f64>() / part.len().max(1) as f64;
    let (roll, moment) = (mean_square(&left[..n_roll]), mean_square(&left[n_roll..]));
    let sds = observation.rough_noise;
    let density =
        |square: f64, sd: f64| -0.5 * square / (sd * sd) - 0.5 * std::f64::consts::TAU.ln();
    let n_moment = left.len() - n_roll;
    let log_density = (n_roll as f64 * density(roll, sds[0])
        + n_moment as f64 * density(moment, sds[1]))
        / left.len() as f64;
    let share = |left: f64, sd: f64, values: &[f64]| {
        let middle = values.iter().sum::<f64>() / values.len() as f64;
        let whole = values.iter().map(|v| (v - middle).powi(2)).sum::<f64>() / values.len() as f64;
        (left - sd * sd).max(0.0) / whole
    };
    let is_forced = observation.at.kind == crate::run::RunKind::Forced;
    let unexplained_share = if is_forced && n_moment > 0 {
        share(moment, sds[1], &observation.moment_n_m)
    } else {
        share(roll, sds[0], &observation.roll_rad)
    };
    HeldOut { rmse_rad: roll.sqrt(), log_density, unexplained_share }
}

/// Mean over runs, with the standard error that their differences show.
fn mean(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    Estimate::normal(mean, (square / (n * (n - 1.0).max(1.0))).sqrt())
}
