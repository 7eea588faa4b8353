//! Whether the best of the effects that were tried may enter the model.

use super::alike::{SAME, contains, is_approximate, is_newest_form_of, is_same};
use super::entered::{ENTERS, Entered};
use super::trial::Tried;
use crate::diagnosis::fit::leftover::{Leftover, excess, leftovers, sure_excess, sure_share};
use crate::diagnosis::fit::settle::Settled;
use crate::diagnosis::fit::survey::Survey;
use crate::model::{Scope, effects};

/// Least logarithm of a Bayes factor at which an effect may enter beside another: no form fits the
/// first to the last digit. By trial on simulated campaigns, as the shares below.
pub(in crate::diagnosis) const ENTERS_BESIDE: f64 = 10.0;
/// Share of what is left for sure that an effect must take away to enter.
const ENOUGH: f64 = 0.2;
/// Share of what an approximate effect removes, and of its evidence, that it may leave of itself:
/// no other effect.
pub(super) const CRUMB: f64 = 0.03;
/// The same for an effect that each run has of its own, which takes up much of anything.
const CRUMB_OF_EACH_RUN: f64 = 0.25;
/// What an effect takes of what is left, over the logarithm of its Bayes factor, where that is
/// what speaks for it; it would be two if nothing else did.
const OF_LEFTOVER: f64 = 1.0;
/// Share of the evidence of an effect below which another may be a want of its form.
pub(in crate::diagnosis) const CRUMB_OF_EVIDENCE: f64 = 0.01;

/// Share of the evidence of an approximate effect to which its form is not known; by trial on a
/// free surface that brought 8e-5 of it for a slow release.
const TRIFLE: f64 = 1e-4;

/// What becomes of the best effect.
pub(super) enum Best {
    /// There is none.
    None,
    /// It may enter.
    Enters(Settled, Entered),
    /// It takes up what an approximate effect of the model leaves of itself.
    IsCrumb(Settled, Entered),
    /// It is sure, and nearly all of what is left stays.
    ExplainsTooLittle,
}

/// Judges the first of the tried effects, best first, with those that cannot be told from it.
pub(super) fn best(
    survey: &Survey,
    current: &Settled,
    mut tried: Vec<Tried>,
    known: &[Entered],
) -> Best {
    prefer_the_part(survey, &mut tried);
    let Some(best) = tried.first() else { return Best::None };
    let log_bayes_factor = best.settled.log_evidence - current.log_evidence;
    if log_bayes_factor < if known.is_empty() { ENTERS } else { ENTERS_BESIDE } {
        return Best::None;
    }
    let (before, after) = (leftovers(survey, &current.fit), leftovers(survey, &best.settled.fit));
    let removed = excess(&before) - excess(&after);
    // Beside another, what makes the runs agree better need not explain what that one leaves.
    let is_beside = !known.is_empty() && !is_of_leftover(removed, log_bayes_factor);
    if !is_beside && !explains_enough(&before, &after, log_bayes_factor) {
        return Best::ExplainsTooLittle;
    }
    let found = (!is_beside).then(|| sure_share(&before));
    let equivalent_to = tried[1..]
        .iter()
        .filter(|one| !contains(one.id, best.id))
        .filter(|one| is_same(survey, current, &best.settled, &one.settled, sure_excess(&after)))
        .map(|one| one.id)
        .collect();
    let entered = Entered { id: best.id, log_bayes_factor, removed, found, equivalent_to };
    let settled = tried.swap_remove(0).settled;
    let scope = settled.fit.extensions.last().map(|newest| newest.effect.scope);
    if known.iter().any(|known| is_crumb_of(known, &entered, scope)) {
        Best::IsCrumb(settled, entered)
    } else {
        Best::Enters(settled, entered)
    }
}

/// Of two that do as well, the one that is a part or a form of the other comes first.
fn prefer_the_part(survey: &Survey, tried: &mut [Tried]) {
    let Some(first) = tried.first() else { return };
    let least = first.settled.log_evidence - 0.25 * SAME;
    let is_part = |id| contains(first.id, id) || is_newest_form_of(survey, &first.settled, id);
    let part =
        tried[1..].iter().position(|one| one.settled.log_evidence > least && is_part(one.id));
    if let Some(k) = part {
        tried[..=k + 1].rotate_right(1);
    }
}

/// Whether an effect is what the form of a known one leaves. What makes the runs agree better
/// takes nothing from what each of them leaves, and is no crumb of that, unless it is that a run
/// is none of the others'.
pub(super) fn is_crumb_of(known: &Entered, newest: &Entered, scope: Option<Scope>) -> bool {
    let is_of_each_run = scope == Some(Scope::Run);
    let is_little = newest.log_bayes_factor < CRUMB_OF_EVIDENCE * known.log_bayes_factor;
    let is_small = newest.log_bayes_factor < CRUMB * known.log_bayes_factor;
    let share = if is_of_each_run { CRUMB_OF_EACH_RUN } else { CRUMB };
    let is_of_form = is_approximate(known.id)
        && (is_of_leftover(newest.removed, newest.log_bayes_factor)
            || is_of_one_layer(known, newest))
        && (newest.removed < share * known.removed && (is_of_each_run || is_small) || is_little);
    // What only few runs may have takes up little of anything.
    let is_odd_of_form = scope == Some(Scope::OddRun) && is_approximate(known.id);
    is_of_form || ((is_of_each_run || is_odd_of_form) && is_little)
}

/// Whether evidence is so little beside that of an approximate effect that the form of that is not
/// known as well, whatever the evidence is of.
pub(super) fn is_trifle_of(known: &Entered, log_bayes_factor: f64) -> bool {
    log_bayes_factor < TRIFLE * known.log_bayes_factor
}

/// Whether two effects are of one layer, where the form of one may want what the other has.
fn is_of_one_layer(known: &Entered, newest: &Entered) -> bool {
    let layer = |id| effects::effect(id).map(|effect| effect.layer);
    layer(known.id) == layer(newest.id)
}

/// Whether what an effect takes of what is left is what speaks for it.
fn is_of_leftover(removed: f64, log_bayes_factor: f64) -> bool {
    removed > OF_LEFTOVER * log_bayes_factor
}

/// Whether an effect takes its part of what is left for sure, or gains as much in making the runs
/// agree: what removes a little of a large remainder is not its cause, whatever its odds.
fn explains_enough(before: &[Leftover], after: &[Leftover], log_bayes_factor: f64) -> bool {
    if !before.iter().any(Leftover::is_structure) {
        return true;
    }
    // A ringing above the frequencies of roll is taken for noise until its cause is known.
    let sure = before.iter().zip(after).filter(|(before, _)| before.is_structure());
    let (n_sure, n_mended) = sure.fold((0, 0), |(all, mended), (before, after)| {
        let is_mended = after.rms.powi(2) < (1.0 - ENOUGH) * before.rms.powi(2);
        (all + 1, mended + usize::from(is_mended))
    });
    let gained = (excess(before) - excess(after)).max(2.0 * log_bayes_factor);
    gained > ENOUGH * sure_excess(before) || 2 * n_mended >= n_sure
}
