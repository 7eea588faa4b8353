//! The model grows by one effect at a time until nothing more is to be named.

use super::alike::{SAME, contains, explained, is_approximate, is_same};
use super::cores;
use super::layout::Layout;
use super::leftover::{self, Leftover};
use super::run_fit::ChannelNoise;
use super::score::{Scored, score};
use super::settle::{Settled, settle};
use super::survey::{Extension, Fit, Survey};
use crate::model::effects;

/// Least logarithm of a Bayes factor at which an effect may enter: one in a thousand by chance.
pub(super) const ENTERS: f64 = 7.0;
/// Share of what is left for sure that an effect must take away to enter.
const ENOUGH: f64 = 0.2;
/// Share of what an approximate effect explains that it may leave of itself.
const CRUMB: f64 = 0.03;
/// Most effects of a model.
const MOST: usize = 5;
/// Times that the base model is settled anew with the noise that it left.
const MOST_STARTS: usize = 6;
/// Effects that are fitted in full at each step.
const FITTED: usize = 6;

/// One effect in the model with what cannot be told from it.
#[derive(Debug, Clone)]
pub(super) struct Entered {
    pub(super) id: &'static str,
    pub(super) log_bayes_factor: f64,
    /// What it explains: the fall of the misfit.
    pub(super) explained: f64,
    /// What it removes of what is left beyond the noise, in units of its variance.
    removed: f64,
    pub(super) equivalent_to: Vec<&'static str>,
}

/// The grown model.
pub(super) struct Grown {
    pub(super) base: Settled,
    pub(super) last: Settled,
    pub(super) noise: Vec<ChannelNoise>,
    pub(super) entered: Vec<Entered>,
    /// Every effect with the logarithm of its Bayes factor against the base model, best first.
    pub(super) ranking: Vec<(&'static str, f64)>,
    /// Effects that would explain more but lie outside their physical range, with that.
    pub(super) implausible: Vec<(&'static str, f64)>,
}

/// A candidate fitted in full.
struct Tried {
    settled: Settled,
    id: &'static str,
}

/// Grows the base model of a campaign.
pub(super) fn grow(survey: &Survey) -> Grown {
    let mut current = settle(survey, survey.first_fit(), &rough_noise(survey));
    let mut noise = white(survey.noise(&current.fit));
    // A fit that starts far away settles as its noise does.
    for _ in 0..MOST_STARTS {
        current = settle(survey, current.fit, &noise);
        let next = white(survey.noise(&current.fit));
        let change = |(a, b): (&ChannelNoise, &ChannelNoise)| (a.sd[0] / b.sd[0] - 1.0).abs();
        let is_still = next.iter().zip(&noise).map(change).all(|change| change < 0.01);
        noise = next;
        if is_still {
            break;
        }
    }
    let base_fit = current.fit.clone();
    let mut entered: Vec<Entered> = Vec::new();
    let (mut ranking, mut implausible) = (Vec::new(), Vec::new());
    while entered.len() < MOST {
        let Some(step) = step(survey, &current, &noise, &entered) else { break };
        if entered.is_empty() {
            ranking.clone_from(&step.ranking);
        }
        implausible.extend(step.implausible);
        let Some(won) = step.won else { break };
        noise = step.noise;
        current = won.0;
        entered.push(won.1);
    }
    if entered.len() > 1 {
        (current, entered) = check_backward(survey, current, entered, &noise);
    }
    let base = settle(survey, base_fit, &noise);
    let mut last = settle(survey, current.fit, &noise);
    while let Some(wild) = (0..entered.len()).find(|e| !is_plausible(survey, &last, *e)) {
        // An effect may have left its range as the others came.
        let Entered { id, log_bayes_factor, .. } = entered.remove(wild);
        implausible.push((id, log_bayes_factor));
        let mut fit = last.fit.clone();
        fit.extensions.remove(wild);
        last = settle(survey, fit, &noise);
    }
    Grown { base, last, noise, entered, ranking, implausible }
}

/// One step of growth.
struct Step {
    /// The grown model, if an effect may enter.
    won: Option<(Settled, Entered)>,
    noise: Vec<ChannelNoise>,
    ranking: Vec<(&'static str, f64)>,
    implausible: Vec<(&'static str, f64)>,
}

/// Tries to add one effect; none when no effect is worth a look.
fn step(
    survey: &Survey,
    before: &Settled,
    noise: &[ChannelNoise],
    entered: &[Entered],
) -> Option<Step> {
    let scores = score(survey, &before.fit, noise);
    let mut ranking: Vec<(&'static str, f64)> =
        scores.iter().map(|s| (s.extension.effect.id, s.log_bayes_factor)).collect();
    let quiet =
        |ranking| Some(Step { won: None, noise: noise.to_vec(), ranking, implausible: Vec::new() });
    if scores.first().is_none_or(|s| s.log_bayes_factor < 0.5 * ENTERS) {
        return quiet(ranking);
    }
    // The noise is what the best explanation leaves, memory included; under it the causes are
    // weighed again.
    let mut first = fit_all(survey, before, &scores[..scores.len().min(3)], noise);
    sort(&mut first);
    let best = &first[0].settled;
    if best.log_evidence < before.log_evidence {
        return quiet(ranking);
    }
    let noise = survey.noise(&best.fit);
    let current = settle(survey, before.fit.clone(), &noise);
    let scores = score(survey, &current.fit, &noise);
    let worth = 0.1 * scores.first().map_or(0.0, |s| s.log_bayes_factor).max(0.0);
    let mut chosen: Vec<Scored> =
        scores.iter().take(FITTED).filter(|s| s.log_bayes_factor >= worth).cloned().collect();
    // What explained most before the noise had a memory is never forgotten.
    for earlier in &first {
        if !chosen.iter().any(|s| s.extension.effect.id == earlier.id)
            && let Some(again) = scores.iter().find(|s| s.extension.effect.id == earlier.id)
        {
            chosen.push(again.clone());
        }
    }
    let mut tried = fit_all(survey, &current, &chosen, &noise);
    sort(&mut tried);
    for one in &tried {
        if let Some(place) = ranking.iter_mut().find(|(id, _)| *id == one.id) {
            place.1 = one.settled.log_evidence - current.log_evidence;
        }
    }
    ranking.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (plausible, wild): (Vec<Tried>, Vec<Tried>) =
        tried.into_iter().partition(|one| is_newest_plausible(survey, &one.settled));
    let implausible: Vec<(&'static str, f64)> = wild
        .iter()
        .map(|one| (one.id, one.settled.log_evidence - current.log_evidence))
        .filter(|(_, log)| *log > ENTERS)
        .collect();
    for one in &plausible {
        let log = one.settled.log_evidence - current.log_evidence;
        let left = excess(&leftovers(survey, &one.settled.fit));
        tracing::debug!(effect = one.id, log, left, "tried");
    }
    for (effect, log) in &implausible {
        tracing::debug!(effect, log, "outside its physical range");
    }
    let won = winner(survey, &current, plausible, entered);
    Some(Step { won, noise, ranking, implausible })
}

fn sort(tried: &mut [Tried]) {
    tried.sort_by(|a, b| b.settled.log_evidence.total_cmp(&a.settled.log_evidence));
}

/// The best of the tried effects, if it may enter, with those that cannot be told from it.
fn winner(
    survey: &Survey,
    current: &Settled,
    plausible: Vec<Tried>,
    known: &[Entered],
) -> Option<(Settled, Entered)> {
    let best = plausible.first()?;
    let log_bayes_factor = best.settled.log_evidence - current.log_evidence;
    if log_bayes_factor < ENTERS {
        return None;
    }
    let (before, after) = (leftovers(survey, &current.fit), leftovers(survey, &best.settled.fit));
    if !explains_enough(&before, &after) {
        return None;
    }
    let explained = explained(survey, current, &best.settled);
    let left = excess(&after);
    let removed = excess(&before) - left;
    // What an approximate effect leaves of itself is no other effect.
    let crumbs = known.iter().filter(|entered| is_approximate(entered.id));
    if crumbs.map(|entered| CRUMB * entered.removed).any(|crumb| removed < crumb) {
        return None;
    }
    let equivalent_to = plausible[1..]
        .iter()
        .filter(|one| !contains(one.id, best.id))
        .filter(|one| is_same(survey, current, &best.settled, &one.settled, left))
        .map(|one| one.id)
        .collect();
    let entered = Entered { id: best.id, log_bayes_factor, explained, removed, equivalent_to };
    plausible.into_iter().next().map(|best| (best.settled, entered))
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

/// Whether an effect takes its part of what is left for sure: what removes a little of a large
/// remainder is not its cause, whatever its odds.
fn explains_enough(before: &[Leftover], after: &[Leftover]) -> bool {
    if !before.iter().any(Leftover::is_sure) {
        return true;
    }
    // A ringing above the frequencies of roll is taken for noise until its cause is known.
    let sure = before.iter().zip(after).filter(|(before, _)| before.is_sure());
    let (n_sure, n_mended) = sure.fold((0, 0), |(all, mended), (before, after)| {
        let is_mended = after.rms.powi(2) < (1.0 - ENOUGH) * before.rms.powi(2);
        (all + 1, mended + usize::from(is_mended))
    });
    excess(before) - excess(after) > ENOUGH * excess(before) || 2 * n_mended >= n_sure
}

/// What is left beyond the noise, in units of its variance.
pub(super) fn excess(all: &[Leftover]) -> f64 {
    all.iter().map(|l| l.excess).sum()
}

/// What a fit leaves of every channel of every run.
pub(super) fn leftovers(survey: &Survey, fit: &Fit) -> Vec<Leftover> {
    survey
        .each_run(&|run| leftover::of(&survey.runs[run], &survey.residual(fit, run)))
        .into_iter()
        .flatten()
        .collect()
}

/// Takes each effect out again: one that is missed too little leaves, and what could stand in its
/// place, the others given, is told with it.
fn check_backward(
    survey: &Survey,
    grown: Settled,
    mut entered: Vec<Entered>,
    noise: &[ChannelNoise],
) -> (Settled, Vec<Entered>) {
    let mut current = settle(survey, grown.fit, noise);
    while let Some((fewer, kept)) = simpler(survey, &current, &entered, noise) {
        (current, entered) = (fewer, kept);
    }
    let mut e = 0;
    while e < entered.len() {
        let mut less = current.fit.clone();
        let taken = less.extensions.remove(e);
        let without = settle(survey, less, noise);
        let missed = current.log_evidence - without.log_evidence;
        if missed < ENTERS {
            current = without;
            entered.remove(e);
            continue;
        }
        let explained = explained(survey, &without, &current);
        let rivals: Vec<Scored> = score(survey, &without.fit, noise)
            .into_iter()
            .filter(|s| {
                s.extension.effect.id != taken.effect.id && s.log_bayes_factor > 0.3 * missed
            })
            .take(4)
            .collect();
        let tried = fit_all(survey, &without, &rivals, noise);
        let left = excess(&leftovers(survey, &current.fit));
        entered[e].log_bayes_factor = missed;
        entered[e].explained = explained;
        entered[e].equivalent_to = tried
            .iter()
            .filter(|one| is_newest_plausible(survey, &one.settled))
            .filter(|one| !contains(one.id, taken.effect.id))
            .filter(|one| is_same(survey, &without, &current, &one.settled, left))
            .map(|one| one.id)
            .collect();
        let better = tried
            .into_iter()
            .filter(|one| is_newest_plausible(survey, &one.settled))
            .filter(|one| one.settled.log_evidence > current.log_evidence + 0.5 * SAME)
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
        }
        e += 1;
    }
    (current, entered)
}

fn rough_noise(survey: &Survey) -> Vec<ChannelNoise> {
    survey
        .runs
        .iter()
        .map(|run| {
            // A first fit must not chase what no equation of roll explains.
            let floor = [1e-3 * run.at.amplitude_rad, 1e-9];
            let sd = std::array::from_fn(|c| run.rough_noise[c].max(floor[c]));
            ChannelNoise { sd, correlation: [0.0; 2] }
        })
        .collect()
}

fn white(mut noise: Vec<ChannelNoise>) -> Vec<ChannelNoise> {
    for one in &mut noise {
        one.correlation = [0.0; 2];
    }
    noise
}

fn fit_all(
    survey: &Survey,
    current: &Settled,
    scores: &[Scored],
    noise: &[ChannelNoise],
) -> Vec<Tried> {
    cores::each(scores.len(), |k| {
        let extension = scores[k].extension.clone();
        let id = extension.effect.id;
        Tried { settled: settle(survey, with(survey, &current.fit, extension, noise), noise), id }
    })
}

/// The model with one more effect: with the strengths that the score gives it where they help as
/// they are, else without any, from where all numbers move together.
fn with(survey: &Survey, fit: &Fit, mut extension: Extension, noise: &[ChannelNoise]) -> Fit {
    let effect = extension.effect;
    let n_strengths = effect.strengths.len();
    for values in &mut extension.slots {
        for (k, value) in values.iter_mut().enumerate() {
            let [low, high] = effect.parameter(k).range;
            *value = value.clamp(low, high);
        }
    }
    let mut idle = fit.clone();
    let mut at_rest = extension.clone();
    at_rest.slots.iter_mut().for_each(|values| values[..n_strengths].fill(0.0));
    idle.extensions.push(at_rest);
    let mut acting = fit.clone();
    for (run, slot) in extension.slot_of.iter().enumerate() {
        let values = slot.map(|slot| &extension.slots[slot]);
        let base = &fit.states[run].base;
        let exchanged = values
            .and_then(|values| effects::exchanged(effect, base, &survey.runs[run].at, values));
        acting.states[run].base = exchanged.unwrap_or(*base);
    }
    acting.extensions.push(extension);
    let is_exchange = (0..survey.runs.len()).any(|r| acting.states[r].base != fit.states[r].base);
    if is_exchange || survey.misfit(&acting, noise) < survey.misfit(&idle, noise) {
        acting
    } else {
        idle
    }
}

/// Whether the newest effect lies inside its physical range.
fn is_newest_plausible(survey: &Survey, settled: &Settled) -> bool {
    settled.fit.extensions.len().checked_sub(1).is_none_or(|e| is_plausible(survey, settled, e))
}

/// Whether an effect lies inside its physical range, as far as its deviation allows.
fn is_plausible(survey: &Survey, settled: &Settled, e: usize) -> bool {
    let extension = &settled.fit.extensions[e];
    let layout = Layout::new(survey, &settled.fit);
    extension.slots.iter().enumerate().all(|(s, values)| {
        (0..extension.effect.strengths.len()).all(|k| {
            let [low, high] = extension.effect.strengths[k].range;
            let column = layout.parameter(&settled.fit, e, s, k);
            let sd = settled.solution.covariance[column][column].max(0.0).sqrt();
            values[k] > low - 2.0 * sd && values[k] < high + 2.0 * sd
        })
    })
}
