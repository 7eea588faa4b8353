//! The shapes of what each run has of its own, chosen again once the model knows more.

use super::entered::Entered;
use super::entry::CRUMB;
use super::onset;
use super::score::score;
use super::trial::with;
use crate::diagnosis::fit::leftover::{Leftover, leftovers};
use crate::diagnosis::fit::run_fit::ChannelNoise;
use crate::diagnosis::fit::settle::{Settled, settle};
use crate::diagnosis::fit::survey::Survey;
use crate::model::Scope;

/// Logarithm of the evidence that a choice must gain to be worth its change: less is what a fit
/// that settles from elsewhere finds by itself.
const WORTH: f64 = 1.0;

/// The model with the shapes of all but its newest effect chosen again, run by run, where those
/// were chosen while the newest was missing and structure is left: a wave that was taken for the
/// next mode of the tank settles in no steps.
pub(super) fn reseated(
    survey: &Survey,
    grown: Settled,
    known: &[Entered],
    newest: &Entered,
    noise: &[ChannelNoise],
) -> Settled {
    let mut current = grown;
    for (e, one) in known.iter().enumerate() {
        let effect = current.fit.extensions[e].effect;
        let is_chosen = effect.scope == Scope::Run && !effect.shapes.is_empty();
        // What so little was missing for was chosen well.
        let is_crumb = newest.log_bayes_factor < CRUMB * one.log_bayes_factor;
        let is_asked = is_chosen && !is_crumb && !survey.cost.is_spent();
        if !is_asked || !is_structure_left(survey, &current) {
            continue;
        }
        let mut less = current.fit.clone();
        less.extensions.remove(e);
        let without = settle(survey, less, noise);
        let scores = score(survey, &without.fit, noise);
        let Some(again) = scores.into_iter().find(|s| s.extension.effect.id == effect.id) else {
            continue;
        };
        let chosen = settle(survey, with(survey, &without.fit, again.extension, noise), noise);
        let mut chosen = onset::placed(survey, chosen, noise).fit;
        if let Some(newest) = chosen.extensions.pop() {
            chosen.extensions.insert(e, newest);
        }
        let chosen = settle(survey, chosen, noise);
        let gained = chosen.log_evidence - current.log_evidence;
        tracing::debug!(effect = effect.id, gained, "chosen again");
        if gained > WORTH {
            current = chosen;
        }
    }
    current
}

fn is_structure_left(survey: &Survey, settled: &Settled) -> bool {
    leftovers(survey, &settled.fit).iter().any(Leftover::is_structure)
}
