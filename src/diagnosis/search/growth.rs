//! The model grows by one effect at a time until nothing more is to be named.

use super::alike::{SAME, is_approximate};
use super::backward::{check_backward, instead};
use super::entered::{ENTERS, Entered};
use super::entry::{Best, CRUMB_OF_EVIDENCE, best};
use super::plausible::{is_newest_plausible, is_plausible};
use super::reseated::reseated;
use super::score::{Scored, score_all_but};
use super::stem::Stem;
use super::trial::{Tried, fit_all};
use crate::diagnosis::fit::leftover::{Leftover, excess, leftovers};
use crate::diagnosis::fit::run_fit::ChannelNoise;
use crate::diagnosis::fit::settle::{Settled, settle};
use crate::diagnosis::fit::survey::{Fit, Survey};
use crate::model::effects;

/// Most effects of a model.
const MOST: usize = 5;
/// Times that a model is settled anew with the noise that it left.
const MOST_STARTS: usize = 6;
/// Effects with impossible numbers that are passed over in one step, so that others come up.
const MOST_PASSED_OVER: usize = 4;
/// Effects that are fitted in full at each step.
const FITTED: usize = 8;

/// The grown model.
pub(in crate::diagnosis) struct Grown {
    pub(in crate::diagnosis) base: Settled,
    pub(in crate::diagnosis) last: Settled,
    pub(in crate::diagnosis) noise: Vec<ChannelNoise>,
    pub(in crate::diagnosis) entered: Vec<Entered>,
    /// Every effect with the logarithm of its Bayes factor against the base model, best first.
    pub(in crate::diagnosis) ranking: Vec<(&'static str, f64)>,
    /// Effects that would explain more but lie outside their physical range, with that.
    pub(in crate::diagnosis) implausible: Vec<(&'static str, f64)>,
    /// Whether a law of no known cause does better than any effect.
    pub(in crate::diagnosis) is_unnamed: bool,
    /// Whether it stopped growing at what that may cost.
    pub(in crate::diagnosis) is_cut_short: bool,
}

impl Grown {
    /// Whether nothing has grown on the base model.
    pub(in crate::diagnosis) fn is_base(&self) -> bool {
        self.last.fit.extensions.is_empty()
    }
}

/// A model as far as it has grown.
#[derive(Clone)]
struct Growing {
    current: Settled,
    noise: Vec<ChannelNoise>,
    entered: Vec<Entered>,
}

/// What steps of growth have found beside the model.
#[derive(Default)]
struct Beside {
    ranking: Vec<(&'static str, f64)>,
    implausible: Vec<(&'static str, f64)>,
    /// Whether a law of no known cause does better than any effects.
    is_unnamed: bool,
}

/// Grows the base model of a campaign, or a stem that is known from other records of it.
pub(in crate::diagnosis) fn grow(survey: &Survey, stem: Option<Stem>) -> Grown {
    survey.cost.begin();
    let (current, noise) = with_its_noise(survey, survey.first_fit(), &rough_noise(survey));
    let base_fit = current.fit.clone();
    let base = Growing { current, noise, entered: Vec::new() };
    let mut beside = Beside::default();
    let mut start = base.clone();
    if let Some(stem) = stem {
        let white = white(survey.noise(&stem.fit));
        let (current, noise) = with_its_noise(survey, stem.fit.clone(), &white);
        let entered = stem.weighed_anew(survey, &base_fit, &current, &noise);
        start = Growing { current, noise, entered };
        beside.ranking = stem.ranking;
    }
    let mut grown = climb(survey, start, &[], &mut beside);
    if let Some((other, found)) = in_another_reading(survey, &base, &grown) {
        (grown, beside) = (other, found);
    }
    if grown.entered.len() > 1 && !survey.cost.is_spent() {
        if let Some(other) = without_the_first(survey, &base, &grown) {
            grown = other;
        }
        let Growing { current, noise, entered } = grown;
        let (current, entered) = check_backward(survey, current, entered, &noise);
        grown = Growing { current, noise, entered };
    }
    let Growing { current, noise, mut entered } = grown;
    let Beside { ranking, mut implausible, is_unnamed } = beside;
    let base = settle(survey, base_fit, &noise);
    let settled = |fit: Fit| {
        if fit.extensions.is_empty() { base.clone() } else { settle(survey, fit, &noise) }
    };
    let mut last = settled(current.fit);
    while let Some(wild) = (0..entered.len()).find(|e| !is_plausible(survey, &last, *e)) {
        // An effect may have left its range as the others came.
        let Entered { id, log_bayes_factor, .. } = entered.remove(wild);
        tracing::debug!(effect = id, "has left its physical range");
        implausible.push((id, log_bayes_factor));
        let mut fit = last.fit.clone();
        fit.extensions.remove(wild);
        last = settled(fit);
    }
    let last = last.over_scatters(survey);
    let base = base.over_scatters(survey);
    let is_cut_short = survey.cost.is_spent();
    Grown { base, last, noise, entered, ranking, implausible, is_unnamed, is_cut_short }
}

/// Lets effects enter one by one, all but those that are banned, until nothing more is to be named.
fn climb(survey: &Survey, start: Growing, banned: &[&'static str], beside: &mut Beside) -> Growing {
    let mut now = start;
    let mut passed_over = banned.to_vec();
    // Where a law of no known cause did best, and what the model was before.
    let mut unnamed: Option<(Fit, Growing)> = None;
    while now.entered.len() < MOST && !survey.cost.is_spent() {
        let Some(step) = step(survey, &now.current, &now.noise, &now.entered, &passed_over) else {
            break;
        };
        // One that explains most with impossible numbers must not hide the others.
        let wild: Vec<&'static str> = step.implausible.iter().map(|(id, _)| *id).collect();
        if now.entered.is_empty() {
            beside.ranking.clone_from(&step.ranking);
        }
        beside.implausible.extend(step.implausible);
        if let Some(fit) = step.unnamed {
            unnamed.get_or_insert_with(|| (fit, now.clone()));
        }
        match step.best {
            Best::Enters(settled, newest) => {
                now.current = reseated(survey, settled, &now.entered, &newest, &step.noise);
                now.entered.push(newest);
                passed_over = banned.to_vec();
            }
            Best::IsCrumb(settled, newest) => {
                let Some(other) = instead(survey, settled, &now.entered, newest, &step.noise)
                else {
                    break;
                };
                (now.current, now.entered) = other;
            }
            Best::ExplainsTooLittle => {
                beside.is_unnamed |= now.entered.is_empty();
                break;
            }
            Best::None
                if !wild.is_empty() && passed_over.len() < banned.len() + MOST_PASSED_OVER =>
            {
                passed_over.extend(wild);
                continue;
            }
            Best::None => break,
        }
        now.noise = step.noise;
    }
    // Two effects together may do better than that law, which does better than either.
    if let Some((fit, before)) = unnamed {
        let law = settle(survey, fit, &now.noise).log_evidence;
        let named = settle(survey, now.current.fit.clone(), &now.noise).log_evidence;
        if now.entered.len() < before.entered.len() + 2 || named < law + 0.5 * SAME {
            beside.is_unnamed = true;
            return before;
        }
    }
    now
}

/// What grows where an effect is read as its twin, and what is found beside it: these are one until
/// another effect turns up that tells them apart, as a damping that depends on the true angle does.
fn in_another_reading(
    survey: &Survey,
    base: &Growing,
    grown: &Growing,
) -> Option<(Growing, Beside)> {
    let has_twin = |id: &str| effects::effect(id).is_some_and(|e| !e.always_equivalent.is_empty());
    let twin = grown.entered.iter().find(|one| has_twin(one.id))?;
    let is_alone = grown.entered.len() == 1;
    let is_left = || leftovers(survey, &grown.current.fit).iter().any(Leftover::is_structure);
    if survey.cost.is_spent() || (is_alone && !is_left()) {
        return None;
    }
    let mut beside = Beside::default();
    let other = climb(survey, base.clone(), &[twin.id], &mut beside);
    let log = |of: &Growing| settle(survey, of.current.fit.clone(), &grown.noise).log_evidence;
    (!other.entered.is_empty() && log(&other) > log(grown) + 0.5 * SAME).then_some((other, beside))
}

/// What grows without the first effect of a model, where that is one that stands for many and
/// others, none of which is such a one, do better than all that grew on it.
fn without_the_first(survey: &Survey, base: &Growing, grown: &Growing) -> Option<Growing> {
    let first = grown.entered.first().filter(|first| is_approximate(first.id))?;
    let mut beside = Beside::default();
    let other = climb(survey, base.clone(), &[first.id], &mut beside);
    let is_exact = !other.entered.iter().any(|one| is_approximate(one.id));
    if beside.is_unnamed || other.entered.is_empty() || !is_exact {
        return None;
    }
    let log = |of: &Growing| settle(survey, of.current.fit.clone(), &grown.noise).log_evidence;
    (log(&other) > log(grown) + 0.5 * SAME).then_some(other)
}

/// A model settled anew with the noise that it leaves: what starts far away settles as its noise
/// does.
fn with_its_noise(
    survey: &Survey,
    start: Fit,
    noise: &[ChannelNoise],
) -> (Settled, Vec<ChannelNoise>) {
    let mut current = settle(survey, start, noise);
    let mut noise = white(survey.noise(&current.fit));
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
    (current, noise)
}

/// One step of growth.
struct Step {
    best: Best,
    noise: Vec<ChannelNoise>,
    ranking: Vec<(&'static str, f64)>,
    implausible: Vec<(&'static str, f64)>,
    /// The model with a law of no known cause, where that does better than with any effect.
    unnamed: Option<Fit>,
}

/// Tries to add one effect; none when no effect is worth a look.
fn step(
    survey: &Survey,
    before: &Settled,
    noise: &[ChannelNoise],
    entered: &[Entered],
    banned: &[&str],
) -> Option<Step> {
    let scored = |fit: &Fit, noise: &[ChannelNoise]| score_all_but(banned, survey, fit, noise);
    let scores = scored(&before.fit, noise);
    let mut ranking: Vec<(&'static str, f64)> =
        scores.iter().map(|s| (s.extension.effect.id, s.log_bayes_factor)).collect();
    ranking.retain(|(id, _)| !effects::is_unnamed(id));
    let quiet = |ranking| {
        let (noise, implausible) = (noise.to_vec(), Vec::new());
        Some(Step { best: Best::None, noise, ranking, implausible, unnamed: None })
    };
    if scores.first().is_none_or(|s| s.log_bayes_factor < 0.5 * ENTERS) {
        return quiet(ranking);
    }
    // The noise is what the best explanation leaves, memory included; under it the causes are
    // weighed again.
    let mut first = fit_all(survey, before, &scores[..scores.len().min(3)], noise);
    sort(&mut first);
    let first_best = &first[0].settled;
    if first_best.log_evidence < before.log_evidence {
        return quiet(ranking);
    }
    let noise = survey.noise(&first_best.fit);
    let current = settle(survey, before.fit.clone(), &noise);
    let scores = scored(&current.fit, &noise);
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
    // What each leaves is worth its cost to those who look on alone.
    if tracing::enabled!(tracing::Level::DEBUG) {
        for one in &plausible {
            let log = one.settled.log_evidence - current.log_evidence;
            let left = excess(&leftovers(survey, &one.settled.fit));
            tracing::debug!(effect = one.id, log, left, "tried");
        }
        tracing::debug!(spent = survey.cost.n_spent(), "stepped");
    }
    for (effect, log) in &implausible {
        tracing::debug!(effect, log, "outside its physical range");
    }
    let unnamed = none_of_them(&current, &plausible, entered);
    let unnamed = unnamed.then(|| plausible[0].settled.fit.clone());
    let known: Vec<Tried> =
        plausible.into_iter().filter(|one| !effects::is_unnamed(one.id)).collect();
    let best = best(survey, &current, known, entered);
    Some(Step { best, noise, ranking, implausible, unnamed })
}

/// Whether a law of no known cause explains the runs better than every effect, best first, does,
/// and more than the want of a form that is known already.
fn none_of_them(current: &Settled, plausible: &[Tried], entered: &[Entered]) -> bool {
    let Some(best) = plausible.first().filter(|one| effects::is_unnamed(one.id)) else {
        return false;
    };
    let second = plausible[1..].iter().map(|one| one.settled.log_evidence).next();
    let others = second.map_or(current.log_evidence, |log| log.max(current.log_evidence));
    let log = best.settled.log_evidence - current.log_evidence;
    log > ENTERS
        && best.settled.log_evidence > others + 0.5 * SAME
        && entered.iter().all(|known| log > CRUMB_OF_EVIDENCE * known.log_bayes_factor)
}

fn sort(tried: &mut [Tried]) {
    tried.sort_by(|a, b| b.settled.log_evidence.total_cmp(&a.settled.log_evidence));
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
