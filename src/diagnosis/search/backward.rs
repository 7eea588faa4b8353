//! The grown model looked back on: effects that are not missed leave, others may take their place.

use std::cell::LazyCell;

use super::alike::{SAME, contains, is_approximate, is_form_of, is_same};
use super::entered::{ENTERS, Entered};
use super::entry::{is_crumb_of, is_trifle_of};
use super::plausible::is_newest_plausible;
use super::score::{Scored, score};
use super::trial::{Tried, fit_all, with};
use crate::diagnosis::fit::leftover::{excess, leftovers, sure_excess};
use crate::diagnosis::fit::run_fit::ChannelNoise;
use crate::diagnosis::fit::settle::{Settled, settle};
use crate::diagnosis::fit::survey::Survey;
use crate::model::{Scope, effects};

/// Takes each effect out again: one that is missed too little leaves, and what could stand in its
/// place, the others given, is told with it.
pub(super) fn check_backward(
    survey: &Survey,
    grown: Settled,
    mut entered: Vec<Entered>,
    noise: &[ChannelNoise],
) -> (Settled, Vec<Entered>) {
    let mut current = settle(survey, grown.fit, noise);
    while !survey.cost.is_spent()
        && let Some((fewer, kept)) = simpler(survey, &current, &entered, noise)
    {
        (current, entered) = (fewer, kept);
    }
    let mut e = 0;
    let mut is_newcomer = false;
    while e < entered.len() && !survey.cost.is_spent() {
        let mut less = current.fit.clone();
        let taken = less.extensions.remove(e);
        let without = settle(survey, less, noise);
        let missed = current.log_evidence - without.log_evidence;
        let looked = LazyCell::new(|| {
            let left = [&without, &current].map(|of| excess(&leftovers(survey, &of.fit)));
            let removed = left[0] - left[1];
            Entered { log_bayes_factor: missed, removed, ..entered[e].clone() }
        });
        // What came before an approximate effect may have taken up a part of it; a run that few
        // have, or a trifle, may be a part of one that was known before it, too.
        let scope = taken.effect.scope;
        let is_crumb = entered.iter().enumerate().any(|(k, other)| {
            let is_asked = k > e || is_newcomer || scope == Scope::OddRun;
            k != e
                && is_approximate(other.id)
                && (is_trifle_of(other, missed)
                    || is_asked && is_crumb_of(other, &looked, Some(scope)))
        });
        if missed < ENTERS || is_crumb {
            (current, is_newcomer) = (without, false);
            entered.remove(e);
            continue;
        }
        if !missed.is_finite() {
            (e, is_newcomer) = (e + 1, false);
            continue;
        }
        // A rest that does not settle judges no other effects.
        let is_settled = without.promised < SAME;
        // What could not be told from it as it entered is asked again, whatever its score.
        let before = entered[e].equivalent_to.clone();
        let (known, other): (Vec<Scored>, Vec<Scored>) = score(survey, &without.fit, noise)
            .into_iter()
            .filter(|s| {
                let id = s.extension.effect.id;
                id != taken.effect.id && !effects::is_unnamed(id)
            })
            .partition(|s| before.contains(&s.extension.effect.id));
        let is_asked = |s: &Scored| is_settled && s.log_bayes_factor > 0.3 * missed;
        let other = other.into_iter().filter(is_asked).take(4);
        let rivals: Vec<Scored> = known.into_iter().chain(other).collect();
        let tried = fit_all(survey, &without, &rivals, noise);
        let left = sure_excess(&leftovers(survey, &current.fit));
        for one in &tried {
            let behind = current.log_evidence - one.settled.log_evidence;
            tracing::debug!(of = taken.effect.id, rival = one.id, behind, missed, "looked back");
        }
        let is_narrower = |id: &str| is_form_of(survey, &current, e, id);
        let is_no_other = |id: &str| contains(id, taken.effect.id) || is_narrower(id);
        // Of a rival that may yet come as near, what was told as this one entered stays.
        let is_equal = |one: &Tried| {
            let Settled { log_evidence, promised, .. } = &one.settled;
            let comes_near = log_evidence + promised > current.log_evidence - SAME;
            is_same(survey, &without, &current, &one.settled, left)
                || (*promised > SAME && comes_near && before.contains(&one.id))
        };
        if is_settled {
            entered[e].log_bayes_factor = missed;
        }
        entered[e].equivalent_to = tried
            .iter()
            .filter(|one| is_newest_plausible(survey, &one.settled) && !is_no_other(one.id))
            .filter(|one| is_equal(one))
            .map(|one| one.id)
            .collect();
        let better = tried
            .into_iter()
            .filter(|one| is_newest_plausible(survey, &one.settled))
            .filter(|one| {
                // A part that does as well is better than the whole.
                let is_part = contains(taken.effect.id, one.id) || is_narrower(one.id);
                let margin = if is_part { -0.25 * SAME } else { 0.5 * SAME };
                one.settled.log_evidence > current.log_evidence + margin
            })
            .max_by(|a, b| a.settled.log_evidence.total_cmp(&b.settled.log_evidence));
        if let Some(better) = better {
            // The newcomer takes the place of the one that was taken out.
            let mut fit = better.settled.fit.clone();
            if let Some(newest) = fit.extensions.pop() {
                fit.extensions.insert(e, newest);
            }
            entered[e].id = better.id;
            entered[e].equivalent_to.retain(|id| *id != better.id);
            current = settle(survey, fit, noise);
            // It is looked back on as any other, once.
            if !is_newcomer {
                is_newcomer = true;
                continue;
            }
        }
        (e, is_newcomer) = (e + 1, false);
    }
    (current, entered)
}

/// A model in which other effects stand in the place of an approximate one that was no more than
/// what two of them look like; `newest` is what it left of itself. None where there is none.
pub(super) fn instead(
    survey: &Survey,
    grown: Settled,
    known: &[Entered],
    newest: Entered,
    noise: &[ChannelNoise],
) -> Option<(Settled, Vec<Entered>)> {
    let evidence = grown.log_evidence;
    let both = known.iter().cloned().chain([newest]).collect();
    let (other, entered) = check_backward(survey, grown, both, noise);
    let is_exact = entered.len() > known.len() && !entered.iter().any(|e| is_approximate(e.id));
    (is_exact && other.log_evidence > evidence + 0.5 * SAME).then_some((other, entered))
}

/// A model with one effect fewer, where another reading of a cause makes it needless.
fn simpler(
    survey: &Survey,
    current: &Settled,
    entered: &[Entered],
    noise: &[ChannelNoise],
) -> Option<(Settled, Vec<Entered>)> {
    let undecided = entered.iter().enumerate().filter(|(_, one)| !one.equivalent_to.is_empty());
    for (place, one) in undecided {
        for needless in (0..entered.len()).filter(|other| *other != place) {
            let mut less = current.fit.clone();
            for taken in [place.max(needless), place.min(needless)] {
                less.extensions.remove(taken);
            }
            let without = settle(survey, less, noise);
            let scores = score(survey, &without.fit, noise);
            for id in &one.equivalent_to {
                let Some(reading) = scores.iter().find(|s| s.extension.effect.id == *id) else {
                    continue;
                };
                let fit = with(survey, &without.fit, reading.extension.clone(), noise);
                let settled = settle(survey, fit, noise);
                if settled.log_evidence > current.log_evidence - 0.25 * SAME
                    && is_newest_plausible(survey, &settled)
                {
                    let mut fit = settled.fit;
                    let newest = fit.extensions.pop()?;
                    let at = place.min(fit.extensions.len());
                    fit.extensions.insert(at, newest);
                    let mut kept = entered.to_vec();
                    kept[place] = Entered { id, equivalent_to: vec![one.id], ..one.clone() };
                    let moved = kept.remove(place);
                    kept.remove(if needless > place { needless - 1 } else { needless });
                    kept.insert(at.min(kept.len()), moved);
                    return Some((settle(survey, fit, noise), kept));
                }
            }
        }
    }
    None
}
