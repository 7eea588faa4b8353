//! A candidate beside the model, fitted in full from where its score stands.

use super::alike::SAME;
use super::onset;
use super::plausible::is_newest_plausible;
use super::score::Scored;
use crate::diagnosis::fit::cores;
use crate::diagnosis::fit::run_fit::ChannelNoise;
use crate::diagnosis::fit::settle::{Settled, Settling, settle};
use crate::diagnosis::fit::survey::{Extension, Fit, Survey};
use crate::model::effects;

/// A candidate fitted in full.
pub(in crate::diagnosis) struct Tried {
    pub(in crate::diagnosis) settled: Settled,
    pub(super) id: &'static str,
}

/// Steps of each candidate from one look at those that fall behind to the next.
const STEPS: usize = 2;
/// Steps after which a candidate that still moves is taken where it is.
const MOST_STEPS: usize = 24;
/// Steps after which those that still matter try whole steps again.
const ANEW: usize = 12;
/// Share of what the best one gains by which another may lie behind and still matter: as much as
/// one that is told as its equal.
const WITHIN_REACH: f64 = 0.1;
/// How much of what a step promises the misfit a candidate may yet gain in evidence; the half of
/// it would be the whole step. By trial on simulated campaigns.
const MAY_GAIN: f64 = 2.0;
/// How often a candidate may yet gain what it has gained in its last looks: what promises much may
/// keep nothing of it. By trial as well.
const MAY_GAIN_AGAIN: f64 = 10.0;
/// So many looks.
const LOOKS: usize = 2;

/// A candidate that is being fitted.
struct Candidate<'a> {
    settling: Settling<'a>,
    settled: Settled,
    /// The largest evidence so far at every look.
    logs: Vec<f64>,
}

impl<'a> Candidate<'a> {
    fn new(mut settling: Settling<'a>) -> Self {
        settling.step_on(STEPS);
        let settled = settling.settled();
        Self { settling, logs: vec![settled.log_evidence], settled }
    }

    fn steps_on(&self, most_steps: usize) -> Self {
        let mut settling = self.settling.clone();
        if most_steps == ANEW + STEPS {
            settling.begin_anew();
        }
        settling.step_on(most_steps);
        let settled = settling.settled();
        let mut logs = self.logs.clone();
        logs.push(settled.log_evidence.max(logs[logs.len() - 1]));
        Self { settling, settled, logs }
    }

    /// Whether it may come so far by more steps, up to so many.
    fn may_reach(&self, reach: f64, most_steps: usize) -> bool {
        let wanted = reach - self.settled.log_evidence;
        if self.settled.promised <= 0.0 || wanted >= MAY_GAIN * self.settled.promised {
            return false;
        }
        if most_steps == ANEW + STEPS {
            return true;
        }
        let [now, then] = [1, 1 + LOOKS].map(|back| self.logs.len().checked_sub(back));
        let gained = now.zip(then).map(|(now, then)| self.logs[now] - self.logs[then]);
        !self.settling.is_done() && gained.is_none_or(|gained| wanted < MAY_GAIN_AGAIN * gained)
    }
}

/// Fits candidates in full, each on a core, as far as they matter.
pub(in crate::diagnosis) fn fit_all(
    survey: &Survey,
    current: &Settled,
    scores: &[Scored],
    noise: &[ChannelNoise],
) -> Vec<Tried> {
    let mut all = cores::each(scores.len(), |k| {
        let mut start = with(survey, &current.fit, scores[k].extension.clone(), noise);
        if onset::has_instants(&start) {
            // Before these are placed it says little of how far it will come.
            let settled = settle(survey, start, noise);
            start = onset::placed(survey, settled, noise).fit;
        }
        Candidate::new(Settling::new(survey, start, noise))
    });
    for most_steps in (2 * STEPS..=MOST_STEPS).step_by(STEPS) {
        let settled = all.iter().map(|one| &one.settled);
        let plausible = settled.filter(|one| is_newest_plausible(survey, one));
        let best = plausible.map(|one| one.log_evidence).fold(f64::NEG_INFINITY, f64::max);
        let reach = best - SAME.max(WITHIN_REACH * (best - current.log_evidence));
        let goes_on = |k: &usize| all[*k].may_reach(reach, most_steps);
        let on: Vec<usize> = (0..all.len()).filter(goes_on).collect();
        let further = cores::each(on.len(), |k| all[on[k]].steps_on(most_steps));
        for (k, further) in on.into_iter().zip(further) {
            all[k] = further;
        }
    }
    let ids = scores.iter().map(|one| one.extension.effect.id);
    ids.zip(all).map(|(id, one)| Tried { settled: one.settled, id }).collect()
}

/// The model with one more effect: with the strengths that the score gives it where they help as
/// they are, else without any, from where all numbers move together.
pub(super) fn with(
    survey: &Survey,
    fit: &Fit,
    mut extension: Extension,
    noise: &[ChannelNoise],
) -> Fit {
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
        // Without its ringing a force that is smaller than that says nothing of when it changes
        // its sign; the other runs do.
        if effect.is_ringing() && slot.is_some() {
            acting.states[run] = survey.lawful(&fit.laws, fit.log_scale, run);
        }
    }
    acting.extensions.push(extension);
    let is_exchange = (0..survey.runs.len()).any(|r| acting.states[r].base != fit.states[r].base);
    if is_exchange || survey.misfit(&acting, noise) < survey.misfit(&idle, noise) {
        acting
    } else {
        idle
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::diagnosis::fit::cost::Spent;
    use crate::diagnosis::fit::long_decay::{NOISE_RAD, long_decay};
    use crate::diagnosis::fit::run_fit::RunState;
    use crate::diagnosis::search::score::score;
    use crate::model::{Base, Term};

    #[test]
    fn candidates_that_fall_behind_cost_little_and_the_best_is_what_it_is_alone() {
        let base = Base { natural_rad_s: 2.46, b1_per_s: 0.02, b3_s: 0.1, log_scale: 0.0 };
        let inertia = effects::effect("inertia.amplitude").expect("an effect of the table");
        let truth = RunState { own: vec![0.3, 0.0, 0.0], base };
        let terms = [Term { effect: inertia, values: vec![-0.8] }];
        let of_campaign = || {
            let spent = Arc::new(Spent::default());
            Survey::new(vec![long_decay(&truth, &terms)], &spent)
        };
        let survey = of_campaign();
        let noise = [ChannelNoise { sd: [NOISE_RAD, 1.0], correlation: [0.0; 2] }];
        let current = settle(&survey, survey.first_fit(), &noise);
        let scores: Vec<Scored> =
            score(&survey, &current.fit, &noise).into_iter().take(8).collect();
        let (alone, together) = (of_campaign(), of_campaign());
        let each = scores.iter().map(|one| {
            let start = with(&alone, &current.fit, one.extension.clone(), &noise);
            let mut settling = Settling::new(&alone, start, &noise);
            settling.step_on(MOST_STEPS);
            settling.settled()
        });
        let most = |logs: &mut dyn Iterator<Item = f64>| logs.fold(f64::NEG_INFINITY, f64::max);
        let best_alone = most(&mut each.map(|settled| settled.log_evidence));
        let tried = fit_all(&together, &current, &scores, &noise);
        let best = most(&mut tried.iter().map(|one| one.settled.log_evidence));
        // A fit has settled where no more than so much misfit is promised to it.
        assert!((best - best_alone).abs() < 0.05, "{best} and {best_alone}");
        let (of_all, of_each) = (together.cost.n_spent(), alone.cost.n_spent());
        assert!(10 * of_all < 9 * of_each, "{of_all} together, {of_each} each alone");
    }
}
