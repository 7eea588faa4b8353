//! The runs of a campaign together, and the model that is fitted to all of them.

use std::sync::Arc;

use super::cores;
use super::observation::Observation;
use super::run_fit::{ChannelNoise, RunState, Summary, misfit, predict, residual, summarise};
use crate::model::{Base, Effect, Term};
use crate::run::RunKind;

/// The runs with the condition that each belongs to.
pub(super) struct Survey {
    pub(super) runs: Vec<Arc<Observation>>,
    /// Names of the conditions.
    pub(super) conditions: Vec<String>,
    /// Place of each run's condition.
    pub(super) condition_of: Vec<usize>,
}

/// Numbers of the law that the runs of a condition scatter about.
pub(super) const N_LAW: usize = 4;

/// `w`, `b1 = b0 + bk Fr^2` and `b3` of one condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Law {
    /// `[w, b0, bk, b3]`.
    pub(super) numbers: [f64; N_LAW],
}

impl Law {
    /// Frequency, linear and cubic damping that the law expects at a Froude number.
    pub(super) fn at(&self, froude: f64) -> [f64; 3] {
        let [w, b0, bk, b3] = self.numbers;
        [w, b0 + bk * froude * froude, b3]
    }
}

/// One effect in the campaign's model.
#[derive(Debug, Clone)]
pub(super) struct Extension {
    pub(super) effect: &'static Effect,
    /// Sets of parameters.
    pub(super) slots: Vec<Vec<f64>>,
    /// Centres of their priors.
    pub(super) centres: Vec<Vec<f64>>,
    /// The set of each run, where the effect acts on it.
    pub(super) slot_of: Vec<Option<usize>>,
}

/// A model of the whole campaign and where its runs stand under it.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub(super) laws: Vec<Law>,
    /// Logarithm of the moment channel's scale.
    pub(super) log_scale: f64,
    pub(super) extensions: Vec<Extension>,
    pub(super) states: Vec<RunState>,
}

impl Fit {
    /// The effects as they act in one run.
    pub(super) fn terms(&self, run: usize) -> Vec<Term> {
        self.extensions.iter().filter_map(|extension| extension.term(run)).collect()
    }
}

impl Extension {
    /// The effect as it acts in one run, if it does.
    pub(super) fn term(&self, run: usize) -> Option<Term> {
        let slot = self.slot_of[run]?;
        Some(Term { effect: self.effect, values: self.slots[slot].clone() })
    }
}

/// Lets runs whose crests are cut off, which identify anything, start from what the whole decays of
/// their condition say.
fn start_cut_off_runs(runs: &mut [Observation]) {
    let is_whole = |run: &Observation| run.facts.clip.is_none() && run.at.kind == RunKind::Decay;
    let whole: Vec<(String, Base)> = runs
        .iter()
        .filter(|run| is_whole(run))
        .map(|run| (run.condition.clone(), run.base))
        .collect();
    for run in runs.iter_mut().filter(|run| run.facts.clip.is_some()) {
        if let Some((_, base)) = whole.iter().find(|(condition, _)| *condition == run.condition) {
            run.base = *base;
        }
    }
}

impl Survey {
    /// Puts runs together.
    pub(super) fn new(mut runs: Vec<Observation>) -> Self {
        let mut conditions: Vec<String> = Vec::new();
        let n_runs = runs.len();
        let largest_rad = runs.iter().map(|run| run.at.amplitude_rad).fold(0.0, f64::max);
        for run in &mut runs {
            run.read_within(largest_rad);
        }
        start_cut_off_runs(&mut runs);
        let condition_of = runs
            .iter_mut()
            .map(|run| {
                run.at.n_runs = n_runs;
                let known = conditions.iter().position(|c| *c == run.condition);
                known.unwrap_or_else(|| {
                    conditions.push(run.condition.clone());
                    conditions.len() - 1
                })
            })
            .collect();
        Self { runs: runs.into_iter().map(Arc::new).collect(), conditions, condition_of }
    }

    /// The fit that the identifications of the runs suggest.
    pub(super) fn first_fit(&self) -> Fit {
        let laws = (0..self.conditions.len())
            .map(|condition| {
                let members = self.members(condition);
                let mean = |of: fn(&Observation) -> f64| {
                    members.iter().map(|r| of(&self.runs[*r])).sum::<f64>() / members.len() as f64
                };
                let (w, b3) = (mean(|r| r.base.natural_rad_s), mean(|r| r.base.b3_s));
                let (x, y) = (mean(|r| r.at.froude.powi(2)), mean(|r| r.base.b1_per_s));
                let (mut sxx, mut sxy) = (0.0, 0.0);
                for r in &members {
                    let dx = self.runs[*r].at.froude.powi(2) - x;
                    sxx += dx * dx;
                    sxy += dx * (self.runs[*r].base.b1_per_s - y);
                }
                let bk = if sxx > 1e-8 { sxy / sxx } else { 0.0 };
                Law { numbers: [w, y - bk * x, bk, b3] }
            })
            .collect();
        let states = self
            .runs
            .iter()
            .map(|run| RunState { own: run.start.clone(), base: run.base })
            .collect();
        Fit { laws, log_scale: 0.0, extensions: Vec::new(), states }
    }

    /// The runs of a condition.
    pub(super) fn members(&self, condition: usize) -> Vec<usize> {
        (0..self.runs.len()).filter(|r| self.condition_of[*r] == condition).collect()
    }

    /// Every run linearised about its state, with the candidates of each.
    pub(super) fn summaries(
        &self,
        fit: &Fit,
        noise: &[ChannelNoise],
        candidates: &(dyn Fn(usize) -> Vec<Term> + Sync),
    ) -> Vec<Summary> {
        self.each_run(&|r| {
            summarise(&self.runs[r], &fit.states[r], &fit.terms(r), &candidates(r), &noise[r])
        })
    }

    /// What the model leaves of a run.
    pub(super) fn residual(&self, fit: &Fit, run: usize) -> Vec<f64> {
        residual(&self.runs[run], &predict(&self.runs[run], &fit.states[run], &fit.terms(run)))
    }

    /// Sum of the squares that the model leaves, in units of the noise.
    pub(super) fn misfit(&self, fit: &Fit, noise: &[ChannelNoise]) -> f64 {
        self.each_run(&|r| misfit(&self.runs[r], &fit.states[r], &fit.terms(r), &noise[r]))
            .into_iter()
            .sum()
    }

    /// Does the same for every run, on every core; the answers are in the order of the runs.
    pub(super) fn each_run<T: Send>(&self, work: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
        cores::each(self.runs.len(), work)
    }

    /// The noise of every channel: at least what neighbouring values show, and what the model
    /// leaves, with its memory where that is sure.
    pub(super) fn noise(&self, fit: &Fit) -> Vec<ChannelNoise> {
        let residuals = self.each_run(&|run| self.residual(fit, run));
        let each = self.runs.iter().zip(&residuals).map(|(run, left)| {
            let n_roll = run.roll_rad.len();
            let mut noise = ChannelNoise { sd: [1.0; 2], correlation: [0.0; 2] };
            for (channel, part) in [&left[..n_roll], &left[n_roll..]].into_iter().enumerate() {
                if part.is_empty() {
                    continue;
                }
                let n = part.len() as f64;
                let variance = part.iter().map(|r| r * r).sum::<f64>() / n;
                let floor = 0.7 * run.rough_noise[channel];
                noise.sd[channel] = variance.sqrt().max(floor).max(1e-9);
                let pairs: f64 = part.windows(2).map(|p| p[0] * p[1]).sum::<f64>() / n;
                let rho = (pairs / variance.max(1e-30)).clamp(0.0, 0.98);
                noise.correlation[channel] = if rho * n.sqrt() > 4.0 { rho } else { 0.0 };
            }
            noise
        });
        each.collect()
    }
}
