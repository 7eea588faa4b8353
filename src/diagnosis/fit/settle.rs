//! Gauss-Newton on all runs together, to the most probable numbers of a model.

use super::run_fit::{ChannelNoise, Summary};
use super::solve::{Solution, followed, moved, prior_misfit, solve, solve_best};
use super::survey::{Fit, Survey};

/// A model at its most probable numbers.
#[derive(Clone)]
pub(in crate::diagnosis) struct Settled {
    pub(in crate::diagnosis) fit: Fit,
    pub(in crate::diagnosis) solution: Solution,
    /// Logarithm of the evidence over all scatters.
    pub(in crate::diagnosis) log_evidence: f64,
    pub(in crate::diagnosis) summaries: Vec<Summary>,
    /// Misfit that it is still promised to lose; that much is not in the evidence.
    pub(in crate::diagnosis) promised: f64,
}

/// Steps after which a model that still moves is taken where it is.
const MOST_STEPS: usize = 12;
/// Steps that the runs' own numbers are given to follow a step of the campaign's.
const FOLLOWING: usize = 3;
/// What they may still gain by it when the campaign steps again.
const UNFOLLOWED: f64 = 1.0;
/// Promised gain in misfit below which a fit has settled.
const SMALL_GAIN: f64 = 0.05;

/// Factor between shares of a step that are tried, and the least of them: five tries, by judgement.
const SMALLER: f64 = 0.3;
const LEAST_SHARE: f64 = 0.008;
/// Share of a step over which it is seen how the readings bend: far above rounding, and short
/// against the step that bends; by judgement.
const LITTLE: f64 = 0.1;

/// Settles a model from where it stands.
pub(in crate::diagnosis) fn settle(survey: &Survey, start: Fit, noise: &[ChannelNoise]) -> Settled {
    let mut settling = Settling::new(survey, start, noise);
    settling.step_on(MOST_STEPS);
    settling.settled()
}

/// A model on its way to its most probable numbers.
#[derive(Clone)]
pub(in crate::diagnosis) struct Settling<'a> {
    survey: &'a Survey,
    noise: &'a [ChannelNoise],
    fit: Fit,
    summaries: Vec<Summary>,
    solution: Solution,
    /// Of all scatters, what is promised counted with it.
    log_evidence: f64,
    n_steps: usize,
    n_followed: usize,
    misfit_before: f64,
    /// The share of a step that went lower last.
    share: f64,
    /// Whether no share of a step goes lower.
    is_stuck: bool,
}

impl<'a> Settling<'a> {
    pub(in crate::diagnosis) fn new(
        survey: &'a Survey,
        start: Fit,
        noise: &'a [ChannelNoise],
    ) -> Self {
        let summaries = survey.summaries(&start, noise, &|_| Vec::new());
        let (solution, log_evidence) = solve_best(survey, &start, &summaries);
        Self {
            survey,
            noise,
            fit: start,
            summaries,
            solution,
            log_evidence,
            n_steps: 0,
            n_followed: 0,
            misfit_before: f64::INFINITY,
            share: 1.0,
            is_stuck: false,
        }
    }

    /// Steps until the model has settled, or has made so many steps from its start on.
    pub(in crate::diagnosis) fn step_on(&mut self, most_steps: usize) {
        while !self.is_done() {
            // A long record bends the valley: the runs' own numbers follow what the campaign's
            // did before it steps again, while that brings them lower.
            let still_falls = self.misfit_before - self.solution.misfit_here > SMALL_GAIN;
            let may_follow = self.n_steps > 0 && self.n_followed < FOLLOWING;
            if may_follow && self.unfollowed() > UNFOLLOWED && still_falls {
                self.misfit_before = self.solution.misfit_here;
                let fit = followed(self.survey, &self.fit, &self.summaries, &self.solution.scatter);
                let summaries = self.survey.summaries(&fit, self.noise, &|_| Vec::new());
                self.n_followed += 1;
                self.stand(fit, summaries);
                continue;
            }
            if self.n_steps == most_steps {
                break;
            }
            match self.stepped() {
                Some((fit, summaries)) => {
                    self.n_steps += 1;
                    (self.n_followed, self.misfit_before) = (0, f64::INFINITY);
                    self.stand(fit, summaries);
                }
                None => self.is_stuck = true,
            }
        }
    }

    fn stand(&mut self, fit: Fit, summaries: Vec<Summary>) {
        (self.solution, self.log_evidence) = solve_best(self.survey, &fit, &summaries);
        (self.fit, self.summaries) = (fit, summaries);
    }

    /// What the misfit would lose to the whole step.
    fn promised(&self) -> f64 {
        self.solution.misfit_here - self.solution.least_misfit
    }

    /// What the runs' own numbers would gain alone.
    fn unfollowed(&self) -> f64 {
        let own: f64 = self.summaries.iter().map(|summary| summary.own_gain).sum();
        own + self.solution.unsettled(self.survey, &self.fit)
    }

    fn is_settled(&self) -> bool {
        self.promised() + self.unfollowed() < SMALL_GAIN
    }

    /// Whether it has settled, or gets no further.
    pub(in crate::diagnosis) fn is_done(&self) -> bool {
        self.is_stuck || self.is_settled()
    }

    /// Tries the whole step again: what bends near one place may be straight at the next.
    pub(in crate::diagnosis) fn begin_anew(&mut self) {
        (self.share, self.is_stuck) = (1.0, false);
        (self.n_followed, self.misfit_before) = (0, f64::INFINITY);
    }

    /// The model where it stands.
    pub(in crate::diagnosis) fn settled(&self) -> Settled {
        let promised = if self.is_settled() { 0.0 } else { self.promised() };
        Settled {
            fit: self.fit.clone(),
            solution: self.solution.clone(),
            // What is promised to a fit that gets no further is no evidence for it.
            log_evidence: self.log_evidence - 0.5 * promised,
            summaries: self.summaries.clone(),
            promised,
        }
    }

    /// A fit that lies lower along the solution's step, summarised; none where there is none.
    ///
    /// What is left of a long record turns with every phase that it has run up, so that a step
    /// along what changes at its start soon leaves the valley. Where the whole step does, the
    /// readings are followed to the second order, for ever smaller shares of it (geodesic
    /// acceleration: Transtrum and Sethna 2012, arXiv:1201.5885).
    fn stepped(&mut self) -> Option<(Fit, Vec<Summary>)> {
        let (survey, noise, fit) = (self.survey, self.noise, &self.fit);
        let (summaries, solution) = (&self.summaries, &self.solution);
        let misfit = |summaries: &[Summary]| summaries.iter().map(|s| s.misfit).sum::<f64>();
        let prior = |fit: &Fit| prior_misfit(survey, fit, &solution.scatter);
        let here = misfit(summaries) + prior(fit);
        let is_lower = |next: &Fit| survey.misfit(next, noise) + prior(next) < here;
        let summarised = |fit: &Fit| survey.summaries(fit, noise, &|_| Vec::new());
        let whole = moved(survey, fit, summaries, solution, 1.0);
        if self.share < 1.0 {
            if is_lower(&whole) {
                self.share = 1.0;
                let there = summarised(&whole);
                return Some((whole, there));
            }
        } else {
            // It is nearly always lower, and its summaries are those of the next round.
            let there = summarised(&whole);
            if misfit(&there) + prior(&whole) < here {
                return Some((whole, there));
            }
        }
        let bends = bends(survey, fit, summaries, solution);
        self.share = (self.share / SMALLER).min(1.0);
        while self.share >= LEAST_SHARE {
            let along = survey.summaries_less(fit, noise, &bends, self.share);
            let curved = solve(survey, fit, &along, solution.scatter);
            let next = moved(survey, fit, &along, &curved, self.share);
            if is_lower(&next) {
                let there = summarised(&next);
                return Some((next, there));
            }
            self.share *= SMALLER;
        }
        None
    }
}

/// What the readings of every run bend away by along the whole of a solution's step.
fn bends(survey: &Survey, fit: &Fit, summaries: &[Summary], solution: &Solution) -> Vec<Vec<f64>> {
    let by = |share: f64| moved(survey, fit, summaries, solution, share);
    let (back, on) = (by(-LITTLE), by(LITTLE));
    survey.each_run(&|run| {
        let readings = |fit: &Fit| survey.readings(fit, run);
        let (back, here, on) = (readings(&back), readings(fit), readings(&on));
        let bend = |((back, here), on)| 0.5 * (back + on - 2.0 * here) / (LITTLE * LITTLE);
        back.iter().zip(&here).zip(&on).map(bend).collect()
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::cost::Spent;
    use super::*;
    use crate::diagnosis::fit::long_decay::{N_SAMPLES, NOISE_RAD, long_decay};
    use crate::diagnosis::fit::run_fit::RunState;
    use crate::diagnosis::fit::survey::Extension;
    use crate::model::effects::effect;
    use crate::model::{Base, Term};

    #[test]
    fn a_wave_near_the_roll_s_own_frequency_is_fitted_to_its_end_in_a_long_decay() {
        let of = |id| effect(id).expect("an effect of the table");
        let (inertia, wave) = (of("inertia.amplitude"), of("tank.residual_wave"));
        let base = Base { natural_rad_s: 2.463, b1_per_s: 0.019, b3_s: 0.16, log_scale: 0.0 };
        let truth = RunState { own: vec![0.3, 0.0, 0.0], base };
        let terms = [
            Term { effect: inertia, values: vec![-0.8] },
            Term { effect: wave, values: vec![4e-3, 5e-3, 2.41, 0.0] },
        ];
        let spent = Arc::new(Spent::default());
        let survey = Survey::new(vec![long_decay(&truth, &terms)], &spent);
        let noise = [ChannelNoise { sd: [NOISE_RAD, 1.0], correlation: [0.0; 2] }];
        let mut settled = settle(&survey, survey.first_fit(), &noise);
        for (effect, start) in [(inertia, vec![0.0]), (wave, vec![0.0, 0.0, 2.44, 0.01])] {
            let (centres, slots) = (vec![start.clone()], vec![start]);
            let mut fit = settled.fit;
            fit.extensions.push(Extension { effect, slots, centres, slot_of: vec![Some(0)] });
            settled = settle(&survey, fit, &noise);
        }
        assert!(settled.promised < SMALL_GAIN, "{} is still promised", settled.promised);
        let misfit = settled.solution.misfit_here / N_SAMPLES as f64;
        assert!((0.9..1.1).contains(&misfit), "{misfit} of the noise");
        let [inertia, wave] = &settled.fit.extensions[..] else { panic!("two effects") };
        assert!((inertia.slots[0][0] + 0.8).abs() < 2e-3, "{:?}", inertia.slots);
        assert!((wave.slots[0][2] - 2.41).abs() < 1e-3, "{:?}", wave.slots);
    }

    #[test]
    fn the_growth_with_speed_is_not_held_by_a_first_run_that_identified_nothing() {
        let decay = |froude: f64, identified_per_s: f64| {
            let b1_per_s = 0.02 + 0.2 * froude * froude;
            let base = Base { natural_rad_s: 2.45, b1_per_s, b3_s: 0.1, log_scale: 0.0 };
            let mut run = long_decay(&RunState { own: vec![0.3, 0.0, 0.0], base }, &[]);
            (run.at.froude, run.at.b1_per_s) = (froude, identified_per_s);
            run
        };
        let runs = vec![decay(0.0, 2e-4), decay(0.2, 0.028), decay(0.4, 0.052)];
        let survey = Survey::new(runs, &Arc::new(Spent::default()));
        let noise = [ChannelNoise { sd: [NOISE_RAD, 1.0], correlation: [0.0; 2] }; 3];
        let settled = settle(&survey, survey.first_fit(), &noise);
        let growth = settled.fit.laws[0].numbers[2];
        assert!((growth - 0.2).abs() < 0.01, "{growth} 1/s");
    }
}
