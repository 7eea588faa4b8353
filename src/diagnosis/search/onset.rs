//! The instant from which an effect acts at once, sought where the model leaves least: readings
//! that jump have no slope to follow.

use std::f64::consts::TAU;

use crate::diagnosis::fit::run_fit::{ChannelNoise, misfit};
use crate::diagnosis::fit::settle::{Settled, settle};
use crate::diagnosis::fit::survey::{Fit, Survey};
use crate::model::Effect;

/// Times that the instants are sought and all other numbers settle with them.
const ROUNDS: usize = 2;
/// Halvings of an eighth of a period, the distance to the nearest node: down to some 2 ms.
const HALVINGS: i32 = 6;

/// Whether the newest effect of a model acts at once from some instant on.
pub(super) fn has_instants(fit: &Fit) -> bool {
    let newest = fit.extensions.last().map(|newest| newest.effect);
    newest.is_some_and(|effect| place_of_instant(effect).is_some())
}

fn place_of_instant(effect: &Effect) -> Option<usize> {
    (0..effect.n_parameters()).find(|k| effect.parameter(*k).is_instant)
}

/// The model with the instants of its newest effect where they leave least of each run; as it was
/// where that effect has none.
pub(super) fn placed(survey: &Survey, settled: Settled, noise: &[ChannelNoise]) -> Settled {
    let Some(newest) = settled.fit.extensions.last() else { return settled };
    let Some(k) = place_of_instant(newest.effect) else { return settled };
    let mut best = settled;
    for _ in 0..ROUNDS {
        let instants = survey.each_run(&|r| sought_s(survey, &best.fit, r, k, &noise[r]));
        let mut fit = best.fit.clone();
        if let Some(newest) = fit.extensions.last_mut() {
            for (slot, instant_s) in newest.slot_of.iter().zip(instants) {
                if let (Some(slot), Some(instant_s)) = (*slot, instant_s) {
                    newest.slots[slot][k] = instant_s;
                    newest.centres[slot][k] = instant_s;
                }
            }
        }
        let moved = settle(survey, fit, noise);
        if moved.log_evidence <= best.log_evidence {
            break;
        }
        best = moved;
    }
    best
}

/// The instant [s] that leaves least of one run; none where the run has not got the effect.
fn sought_s(survey: &Survey, fit: &Fit, run: usize, k: usize, noise: &ChannelNoise) -> Option<f64> {
    let place = fit.terms(run).len().checked_sub(1)?;
    let own = fit.extensions.last()?.term(run)?;
    let observed = &survey.runs[run];
    let left = |instant_s: f64| {
        let mut terms = fit.terms(run);
        terms[place].values[k] = instant_s;
        misfit(observed, &fit.states[run], &terms, noise)
    };
    let mut step_s = 0.125 * TAU / observed.at.rolling_rad_s;
    let (mut best_s, mut least) = (own.values[k], left(own.values[k]));
    for _ in 0..HALVINGS {
        for there_s in [best_s - step_s, best_s + step_s] {
            let there = left(there_s);
            if there < least {
                (best_s, least) = (there_s, there);
            }
        }
        step_s *= 0.5;
    }
    Some(best_s)
}
