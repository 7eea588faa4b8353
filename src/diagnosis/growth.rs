//! The model grows by one effect at a time until nothing more is to be named.

use super::run_fit::ChannelNoise;
use super::score::{Scored, score};
use super::settle::{Settled, settle};
use super::survey::{Extension, Fit, Survey};

/// Least logarithm of a Bayes factor at which an effect may enter: one in a thousand by chance.
pub(super) const ENTERS: f64 = 7.0;
/// Difference of misfits below which two effects cannot be told apart.
const SAME: f64 = 12.0;
/// The same as a share of what the effect explains.
const SAME_SHARE: f64 = 0.01;
/// Most effects of a model.
const MOST: usize = 5;
/// Effects that are fitted in full at each step.
const FITTED: usize = 7;

/// One effect in the model with what cannot be told from it.
#[derive(Debug, Clone)]
pub(super) struct Entered {
    pub(super) id: &'static str,
    pub(super) log_bayes_factor: f64,
    /// What it explains: the fall of the misfit.
    pub(super) explained: f64,
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
    let first = survey.first_fit();
    let mut noise = rough_noise(survey);
    let start = settle(survey, first, &noise);
    noise = white(survey.noise(&start.fit));
    let mut current = settle(survey, start.fit, &noise);
    let mut base_fit = current.fit.clone();
    let mut entered: Vec<Entered> = Vec::new();
    let mut ranking = Vec::new();
    let mut implausible = Vec::new();
    while entered.len() < MOST {
        let scores = score(survey, &current.fit, &noise);
        if entered.is_empty() {
            ranking = scores.iter().map(|s| (s.extension.effect.id, s.log_bayes_factor)).collect();
        }
        if scores.first().is_none_or(|s| s.log_bayes_factor < 0.5 * ENTERS) {
            break;
        }
        // The noise is what the best explanation leaves, memory included; under it the causes are
        // weighed again.
        let mut tried = fit_all(survey, &current, &scores[..scores.len().min(3)], &noise);
        tried.sort_by(|a, b| b.settled.log_evidence.total_cmp(&a.settled.log_evidence));
        let best = &tried[0].settled;
        if best.log_evidence < current.log_evidence {
            break;
        }
        let next_noise = survey.noise(&best.fit);
        current = settle(survey, current.fit, &next_noise);
        let scores = score(survey, &current.fit, &next_noise);
        let mut chosen: Vec<Scored> = scores.iter().take(FITTED).cloned().collect();
        // What explained most before the noise had a memory is never forgotten.
        for earlier in &tried {
            if !chosen.iter().any(|s| s.extension.effect.id == earlier.id)
                && let Some(again) = scores.iter().find(|s| s.extension.effect.id == earlier.id)
            {
                chosen.push(again.clone());
            }
        }
        let mut tried = fit_all(survey, &current, &chosen, &next_noise);
        let before = misfit(&current);
        tried.sort_by(|a, b| b.settled.log_evidence.total_cmp(&a.settled.log_evidence));
        if entered.is_empty() {
            for one in &tried {
                let log = one.settled.log_evidence - current.log_evidence;
                if let Some(place) = ranking.iter_mut().find(|(id, _)| *id == one.id) {
                    place.1 = log;
                }
            }
            ranking.sort_by(|a, b| b.1.total_cmp(&a.1));
        }
        let (plausible, wild): (Vec<Tried>, Vec<Tried>) =
            tried.into_iter().partition(|one| is_plausible(survey, &one.settled));
        for one in &wild {
            let log = one.settled.log_evidence - current.log_evidence;
            if log > ENTERS {
                implausible.push((one.id, log));
            }
        }
        let Some(best) = plausible.first() else { break };
        let log_bayes_factor = best.settled.log_evidence - current.log_evidence;
        if log_bayes_factor < ENTERS {
            break;
        }
        let explained = before - misfit(&best.settled);
        let room = SAME.max(SAME_SHARE * explained);
        let equivalent_to = plausible[1..]
            .iter()
            .filter(|one| 2.0 * (best.settled.log_evidence - one.settled.log_evidence) < room)
            .map(|one| one.id)
            .collect();
        entered.push(Entered { id: best.id, log_bayes_factor, explained, equivalent_to });
        noise = next_noise;
        if entered.len() == 1 {
            base_fit = current.fit.clone();
        }
        current = plausible.into_iter().next().map_or(current, |one| one.settled);
    }
    let base = settle(survey, base_fit, &noise);
    let last = settle(survey, current.fit, &noise);
    Grown { base, last, noise, entered, ranking, implausible }
}

fn misfit(settled: &Settled) -> f64 {
    settled.solution.misfit_here
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
    noise.iter_mut().for_each(|n| n.correlation = [0.0; 2]);
    noise
}

fn fit_all(
    survey: &Survey,
    current: &Settled,
    scores: &[Scored],
    noise: &[ChannelNoise],
) -> Vec<Tried> {
    scores
        .iter()
        .map(|scored| {
            let settled = settle(survey, with(&current.fit, scored.extension.clone()), noise);
            Tried { settled, id: scored.extension.effect.id }
        })
        .collect()
}

/// The model with one more effect, its strengths brought into their range.
fn with(fit: &Fit, mut extension: Extension) -> Fit {
    let effect = extension.effect;
    for values in &mut extension.slots {
        for (k, value) in values.iter_mut().enumerate() {
            let [low, high] = effect.parameter(k).range;
            *value = value.clamp(low, high);
        }
    }
    let mut fit = fit.clone();
    fit.extensions.push(extension);
    fit
}

/// Whether the newest effect lies inside its physical range, as far as its deviation allows.
fn is_plausible(survey: &Survey, settled: &Settled) -> bool {
    let Some(extension) = settled.fit.extensions.last() else { return true };
    let layout = super::solve::Layout::new(survey, &settled.fit);
    let e = settled.fit.extensions.len() - 1;
    extension.slots.iter().enumerate().all(|(s, values)| {
        (0..extension.effect.strengths.len()).all(|k| {
            let [low, high] = extension.effect.strengths[k].range;
            let column = layout.parameter(&settled.fit, e, s, k);
            let sd = settled.solution.covariance[column][column].max(0.0).sqrt();
            values[k] > low - 2.0 * sd && values[k] < high + 2.0 * sd
        })
    })
}
