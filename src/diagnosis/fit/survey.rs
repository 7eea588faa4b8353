//! The runs of a campaign together, and the model that is fitted to all of them.

use std::sync::Arc;

use super::cores;
use super::cost::{Cost, Spent};
use super::run_fit::{ChannelNoise, RunState, Summary, misfit, predict, residual, summarise};
use crate::diagnosis::record::observation::Observation;
use crate::model::{Base, Effect, N_BASE, Scope, Term};

/// The runs with the condition that each belongs to.
pub(in crate::diagnosis) struct Survey {
    pub(in crate::diagnosis) runs: Vec<Arc<Observation>>,
    /// Names of the conditions.
    pub(in crate::diagnosis) conditions: Vec<String>,
    /// Place of each run's condition.
    pub(in crate::diagnosis) condition_of: Vec<usize>,
    /// What its fits cost and may cost.
    pub(in crate::diagnosis) cost: Cost,
}

/// Numbers of the law that the runs of a condition scatter about.
pub(in crate::diagnosis) const N_LAW: usize = 4;

/// `w`, `b1 = b0 + bk Fr^2` and `b3` of one condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::diagnosis) struct Law {
    /// `[w, b0, bk, b3]`.
    pub(in crate::diagnosis) numbers: [f64; N_LAW],
}

impl Law {
    /// Frequency, linear and cubic damping that the law expects at a Froude number.
    pub(in crate::diagnosis) fn at(&self, froude: f64) -> [f64; 3] {
        let [w, b0, bk, b3] = self.numbers;
        [w, b0 + bk * froude * froude, b3]
    }
}

/// One effect in the campaign's model.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Extension {
    pub(in crate::diagnosis) effect: &'static Effect,
    /// Sets of parameters.
    pub(in crate::diagnosis) slots: Vec<Vec<f64>>,
    /// Centres of their priors.
    pub(in crate::diagnosis) centres: Vec<Vec<f64>>,
    /// The set of each run, where the effect acts on it.
    pub(in crate::diagnosis) slot_of: Vec<Option<usize>>,
}

/// A model of the whole campaign and where its runs stand under it.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Fit {
    pub(in crate::diagnosis) laws: Vec<Law>,
    /// Logarithm of the moment channel's scale.
    pub(in crate::diagnosis) log_scale: f64,
    pub(in crate::diagnosis) extensions: Vec<Extension>,
    pub(in crate::diagnosis) states: Vec<RunState>,
}

/// How many numbers effects have in one run.
pub(in crate::diagnosis) fn n_values(terms: &[Term]) -> usize {
    terms.iter().map(|term| term.values.len()).sum()
}

impl Fit {
    /// The effects as they act in one run.
    pub(in crate::diagnosis) fn terms(&self, run: usize) -> Vec<Term> {
        self.extensions.iter().filter_map(|extension| extension.term(run)).collect()
    }
}

impl Extension {
    /// The effect as it acts in one run, if it does.
    pub(in crate::diagnosis) fn term(&self, run: usize) -> Option<Term> {
        let slot = self.slot_of[run]?;
        Some(Term { effect: self.effect, values: self.slots[slot].clone() })
    }

    /// The same in other runs: those at `places` of its own have the sets that they have there, and
    /// any other has that of the runs like it.
    fn of_runs(&self, survey: &Survey, other: &Survey, places: &[Option<usize>]) -> Self {
        let is_like = |run: usize, known: usize| match self.effect.scope {
            Scope::Campaign => true,
            Scope::Condition => survey.runs[run].condition == other.runs[known].condition,
            Scope::Run | Scope::OddRun => false,
        };
        let like = |run: usize| {
            let mut all = self.slot_of.iter().enumerate();
            all.find_map(|(known, slot)| slot.filter(|_| is_like(run, known)))
        };
        let mut kept: Vec<usize> = Vec::new();
        let slot_of = places.iter().enumerate().map(|(run, place)| {
            let slot = match place {
                Some(place) => self.slot_of[*place],
                None => like(run).filter(|_| (self.effect.shows)(&survey.runs[run].at)),
            }?;
            Some(kept.iter().position(|one| *one == slot).unwrap_or_else(|| {
                kept.push(slot);
                kept.len() - 1
            }))
        });
        let slot_of = slot_of.collect();
        let of = |sets: &[Vec<f64>]| kept.iter().map(|slot| sets[*slot].clone()).collect();
        Self { effect: self.effect, slots: of(&self.slots), centres: of(&self.centres), slot_of }
    }
}

impl Survey {
    /// Puts runs together, for a diagnosis that has cost so much.
    pub(in crate::diagnosis) fn new(mut runs: Vec<Observation>, spent: &Arc<Spent>) -> Self {
        let mut conditions: Vec<String> = Vec::new();
        let largest_rad = runs.iter().map(Observation::half_range_rad).fold(0.0, f64::max);
        // A channel has one range: crests that are flat wherever they are have another cause.
        let is_clipped = |run: &&Observation| run.facts.clip.is_some();
        let n_clipped = runs.iter().filter(is_clipped).count();
        let n_within = runs.iter().filter(is_clipped).filter(|run| run.is_below(largest_rad));
        if 2 * n_within.count() > n_clipped {
            for run in &mut runs {
                run.facts.clip = None;
            }
        }
        let read = |run: &mut Observation| run.read_within(largest_rad);
        let is_enough: Vec<bool> = runs.iter_mut().map(read).collect();
        if is_enough.iter().any(|enough| *enough) {
            let mut is_enough = is_enough.into_iter();
            runs.retain(|_| is_enough.next() != Some(false));
        }
        let n_runs = runs.len();
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
        let runs = runs.into_iter().map(Arc::new).collect();
        Self { runs, conditions, condition_of, cost: Cost::new(spent) }
    }

    /// The fit that the identifications of the runs suggest.
    pub(in crate::diagnosis) fn first_fit(&self) -> Fit {
        let n_conditions = self.conditions.len();
        let middling: Vec<Base> = (0..n_conditions).map(|c| self.middling_base(c)).collect();
        let states = self.each_run(&|run| self.start(run, middling[self.condition_of[run]]));
        let laws = (0..n_conditions).map(|condition| self.first_law(condition, &states)).collect();
        Fit { laws, log_scale: 0.0, extensions: Vec::new(), states }
    }

    /// A fit to other records of the same runs, or of some of them, from which a fit to these can
    /// start; none where a condition has no such run.
    pub(in crate::diagnosis) fn adopted(&self, other: &Self, fit: &Fit) -> Option<Fit> {
        let place = |run: &Arc<Observation>| other.runs.iter().position(|o| o.id == run.id);
        let places: Vec<Option<usize>> = self.runs.iter().map(place).collect();
        let law = |name: &String| {
            let known = other.conditions.iter().position(|c| c == name)?;
            Some(fit.laws[known])
        };
        let laws: Vec<Law> = self.conditions.iter().map(law).collect::<Option<_>>()?;
        let state = |run: usize| {
            let known = places[run].map(|place| fit.states[place].clone());
            known.unwrap_or_else(|| self.lawful(&laws, fit.log_scale, run))
        };
        let extensions = fit.extensions.iter().map(|one| one.of_runs(self, other, &places));
        Some(Fit {
            log_scale: fit.log_scale,
            extensions: extensions.collect(),
            states: (0..self.runs.len()).map(state).collect(),
            laws,
        })
    }

    /// A run as its record shows it, under the law of its condition.
    pub(in crate::diagnosis) fn lawful(
        &self,
        laws: &[Law],
        log_scale: f64,
        run: usize,
    ) -> RunState {
        let observation = &self.runs[run];
        let law = laws[self.condition_of[run]].at(observation.at.froude);
        let [natural_rad_s, b1_per_s, b3_s] = law;
        let base = Base { natural_rad_s, b1_per_s, b3_s, log_scale };
        RunState { own: observation.start.clone(), base }
    }

    /// The law through the numbers of a condition's runs.
    fn first_law(&self, condition: usize, states: &[RunState]) -> Law {
        let members = self.members(condition);
        let n = members.len() as f64;
        let mean = |of: &dyn Fn(usize) -> f64| members.iter().map(|r| of(*r)).sum::<f64>() / n;
        let square = |r: usize| self.runs[r].at.froude.powi(2);
        let (w, b3) = (mean(&|r| states[r].base.natural_rad_s), mean(&|r| states[r].base.b3_s));
        let (x, y) = (mean(&square), mean(&|r| states[r].base.b1_per_s));
        let (mut sxx, mut sxy) = (0.0, 0.0);
        for r in &members {
            let dx = square(*r) - x;
            sxx += dx * dx;
            sxy += dx * (states[*r].base.b1_per_s - y);
        }
        let bk = if sxx > 1e-8 { sxy / sxx } else { 0.0 };
        Law { numbers: [w, y - bk * x, bk, b3] }
    }

    /// Medians of what the runs of a condition identify.
    fn middling_base(&self, condition: usize) -> Base {
        let members = self.members(condition);
        let median = |of: fn(&Base) -> f64| {
            let mut all: Vec<f64> = members.iter().map(|r| of(&self.runs[*r].base)).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        };
        Base {
            natural_rad_s: median(|base| base.natural_rad_s),
            b1_per_s: median(|base| base.b1_per_s),
            b3_s: median(|base| base.b3_s),
            log_scale: 0.0,
        }
    }

    /// Linear damping of the middling run of a condition [1/s]: any one may be ill identified.
    pub(super) fn usual_damping_per_s(&self, condition: usize) -> f64 {
        let members = self.members(condition).into_iter();
        let mut all: Vec<f64> = members.map(|run| self.runs[run].at.b1_per_s).collect();
        let middle = all.len() / 2;
        *all.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Where a run starts: at its own numbers, or at those of a middling run or without cubic
    /// damping where these do better; what a record with crests cut off or an odd law identifies
    /// may be far from any.
    fn start(&self, run: usize, middling: Base) -> RunState {
        let observation = &self.runs[run];
        let noise = ChannelNoise { sd: observation.rough_noise, correlation: [0.0; 2] };
        let left = |state: &RunState| {
            let misfit = misfit(observation, state, &[], &noise);
            if misfit.is_finite() { misfit } else { f64::MAX }
        };
        let own = observation.base;
        let bases = [own, middling, Base { b3_s: 0.0, ..own }, Base { b3_s: 0.0, ..middling }];
        let states = bases.map(|base| RunState { own: observation.start.clone(), base });
        let [first, others @ ..] = states;
        others.into_iter().fold(
            first,
            |best, other| {
                if left(&other) < left(&best) { other } else { best }
            },
        )
    }

    /// The runs of a condition.
    pub(in crate::diagnosis) fn members(&self, condition: usize) -> Vec<usize> {
        (0..self.runs.len()).filter(|r| self.condition_of[*r] == condition).collect()
    }

    /// Counts a simulation of a run with so many changes.
    pub(in crate::diagnosis) fn spend(&self, run: usize, terms: &[Term], n_changes: usize) {
        let observation = &self.runs[run];
        let n_values = observation.roll_time_s.len() + observation.moment_time_s.len();
        self.cost.spend(n_values, terms, n_changes);
    }

    /// Every run linearised about its state, with the candidates of each.
    pub(in crate::diagnosis) fn summaries(
        &self,
        fit: &Fit,
        noise: &[ChannelNoise],
        candidates: &(dyn Fn(usize) -> Vec<Term> + Sync),
    ) -> Vec<Summary> {
        self.each_run(&|r| {
            let (terms, candidates) = (fit.terms(r), candidates(r));
            let n_own = fit.states[r].own.len() + N_BASE + n_values(&terms);
            self.spend(r, &terms, n_own + n_values(&candidates));
            summarise(&self.runs[r], &fit.states[r], &terms, &candidates, &noise[r], None)
        })
    }

    /// The same without candidates, a share of something taken off what was read.
    pub(super) fn summaries_less(
        &self,
        fit: &Fit,
        noise: &[ChannelNoise],
        less: &[Vec<f64>],
        share: f64,
    ) -> Vec<Summary> {
        self.each_run(&|r| {
            let terms = fit.terms(r);
            self.spend(r, &terms, fit.states[r].own.len() + N_BASE + n_values(&terms));
            summarise(
                &self.runs[r],
                &fit.states[r],
                &terms,
                &[],
                &noise[r],
                Some((&less[r], share)),
            )
        })
    }

    /// What the model reads in a run.
    pub(super) fn readings(&self, fit: &Fit, run: usize) -> Vec<f64> {
        let terms = fit.terms(run);
        self.spend(run, &terms, 0);
        predict(&self.runs[run], &fit.states[run], &terms)
    }

    /// What the model leaves of a run.
    pub(in crate::diagnosis) fn residual(&self, fit: &Fit, run: usize) -> Vec<f64> {
        residual(&self.runs[run], &predict(&self.runs[run], &fit.states[run], &fit.terms(run)))
    }

    /// Sum of the squares that the model leaves, in units of the noise.
    pub(in crate::diagnosis) fn misfit(&self, fit: &Fit, noise: &[ChannelNoise]) -> f64 {
        let of_run = |r: usize| {
            let terms = fit.terms(r);
            self.spend(r, &terms, 0);
            misfit(&self.runs[r], &fit.states[r], &terms, &noise[r])
        };
        self.each_run(&of_run).into_iter().sum()
    }

    /// Does the same for every run, on every core; the answers are in the order of the runs.
    pub(in crate::diagnosis) fn each_run<T: Send>(
        &self,
        work: &(dyn Fn(usize) -> T + Sync),
    ) -> Vec<T> {
        cores::each(self.runs.len(), work)
    }

    /// The noise of every channel: at least what neighbouring values show, and what the model
    /// leaves, with its memory where that is sure.
    pub(in crate::diagnosis) fn noise(&self, fit: &Fit) -> Vec<ChannelNoise> {
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
