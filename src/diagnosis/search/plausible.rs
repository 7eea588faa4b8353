//! Whether an effect of a model lies inside its physical range.

use crate::diagnosis::fit::layout::Layout;
use crate::diagnosis::fit::settle::Settled;
use crate::diagnosis::fit::survey::{Extension, Survey};
use crate::model::{Acts, Scope};

/// Share of its range within which a shape is held at an edge, and would rather be outside.
const EDGE: f64 = 1e-3;

/// Shares of damping and restoring within which the run of another label would be one of its own:
/// hulls and speeds that differ by no more are not mistaken for each other. By judgement.
const ONE_LABEL: [f64; 2] = [0.05, 0.02];

/// Whether the newest effect lies inside its physical range.
pub(super) fn is_newest_plausible(survey: &Survey, settled: &Settled) -> bool {
    settled.fit.extensions.len().checked_sub(1).is_none_or(|e| is_plausible(survey, settled, e))
}

/// Whether an effect lies inside its physical range: its strengths as far as their deviations
/// allow, the shapes of a memory off the edges at which they are held, the frequencies of a wave
/// among those of the tank, a run of another label far enough from its own. Other shapes may lie
/// at an edge: friction is as sharp as can be.
pub(super) fn is_plausible(survey: &Survey, settled: &Settled, e: usize) -> bool {
    let extension = &settled.fit.extensions[e];
    let layout = Layout::new(survey, &settled.fit);
    let n_strengths = extension.effect.strengths.len();
    let is_label = |values: &Vec<f64>| values.iter().zip(ONE_LABEL).any(|(v, of)| v.abs() > of);
    let is_of_few = extension.effect.scope == Scope::OddRun;
    if is_of_few && !extension.slots.iter().all(is_label) {
        return false;
    }
    if log_odds(survey, settled, e, &layout) < 0.0 {
        return false;
    }
    extension.slots.iter().enumerate().all(|(s, values)| {
        let remembers = matches!(extension.effect.acts, Acts::Lagging(_));
        let is_held = remembers
            && values[n_strengths..].iter().enumerate().any(|(k, value)| {
                let [low, high] = extension.effect.shapes[k].range;
                let edge = EDGE * (high - low);
                *value < low + edge || *value > high - edge
            });
        let is_strong = (0..n_strengths).all(|k| {
            let [low, high] = extension.effect.strengths[k].range;
            let column = layout.parameter(&settled.fit, e, s, k);
            let sd = settled.solution.covariance[column][column].max(0.0).sqrt();
            values[k] > low - 2.0 * sd && values[k] < high + 2.0 * sd
        });
        is_strong && !is_held
    })
}

/// Share of a parameter's prior deviation that runs which say something of it leave at most; by
/// judgement, on a lost keel that a wave known no better than before made a wave.
const MOSTLY_KNOWN: f64 = 0.9;

/// Logarithm of the odds, over all runs, that the parameters of an effect are those of its cause.
fn log_odds(survey: &Survey, settled: &Settled, e: usize, layout: &Layout) -> f64 {
    let Extension { effect, slots, slot_of, .. } = &settled.fit.extensions[e];
    let of_slot = |run: usize, s: usize| -> f64 {
        let each = (0..effect.n_parameters()).map(|k| (k, effect.parameter(k)));
        each.filter_map(|(k, parameter)| {
            let column = layout.parameter(&settled.fit, e, s, k);
            let sd = settled.solution.covariance[column][column].max(0.0).sqrt();
            // What is known no better than before speaks neither for nor against.
            let is_known = sd < MOSTLY_KNOWN * parameter.typical;
            let odds = parameter.odds.filter(|_| is_known)?;
            Some(odds(&survey.runs[run].at, slots[s][k], sd))
        })
        .sum()
    };
    // A set that many runs share is asked about once, in the first of them.
    let first_of = |s: usize| slot_of.iter().position(|slot| *slot == Some(s));
    (0..slots.len()).filter_map(|s| Some(of_slot(first_of(s)?, s))).sum()
}
