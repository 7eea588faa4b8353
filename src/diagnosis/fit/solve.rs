//! All runs solved together: laws and effects common, each run's scatter about the law marginal.

use super::elimination::{Eliminated, Place, Products, Side};
use super::layout::Layout;
use super::run_fit::{RunState, Summary};
use super::scatter::{Scatter, deviation, scatters, spread};
use super::survey::{Extension, Fit, N_LAW, Survey};

const LOG_SCALE_SD: f64 = 0.03;
/// Prior standard deviation of `bk` as a multiple of the usual damping: kappa of the paper is 12.
const KAPPA_SD: f64 = 30.0;

/// Numbers by which a run deviates from its law.
const N_DEVIATIONS: usize = 3;

/// One run with its scatter eliminated.
#[derive(Clone)]
pub(in crate::diagnosis) struct Marginal {
    /// What is left are base, terms, record.
    pub(in crate::diagnosis) eliminated: Eliminated,
    pub(in crate::diagnosis) log_occam: f64,
}

/// A run's deviation from its law, then base, terms, record.
pub(super) fn deviating(survey: &Survey, fit: &Fit, run: usize, summary: &Summary) -> Products {
    let own = &summary.eliminated.rest;
    let n = own.n() + N_DEVIATIONS;
    let mut products = Products::zero(n);
    products.gather(own, &deviating_places(survey, fit, run, n));
    products
}

/// Base, terms and record stay; a change of the base is a deviation, and stands where it does now.
fn deviating_places(survey: &Survey, fit: &Fit, run: usize, n: usize) -> Vec<Place> {
    let mut places: Vec<Place> =
        (0..n - N_DEVIATIONS).map(|i| Place::new(i, N_DEVIATIONS + i)).collect();
    for (i, now) in deviation(survey, fit, run).into_iter().enumerate() {
        places.push(Place::new(i, i));
        places.push(Place { theirs: i, ours: n - 1, by: now });
    }
    places
}

/// Eliminates a run's deviation from its law.
pub(super) fn marginal(
    survey: &Survey,
    fit: &Fit,
    run: usize,
    mut products: Products,
    scatter: &Scatter,
) -> Marginal {
    let mut log_precision = 0.0;
    for (i, sd) in spread(survey, fit, run, scatter).into_iter().enumerate() {
        products.add(i, i, sd.powi(-2));
        log_precision -= 2.0 * sd.ln();
    }
    let eliminated = products.eliminate(N_DEVIATIONS);
    let log_occam = -0.5 * (eliminated.log_determinant - log_precision);
    Marginal { eliminated, log_occam }
}

/// The runs about where a fit stands, ready to be solved for one scatter after the other.
pub(in crate::diagnosis) struct Joint<'a> {
    survey: &'a Survey,
    fit: &'a Fit,
    pub(in crate::diagnosis) layout: Layout,
    pub(in crate::diagnosis) places: Vec<Vec<Place>>,
    /// Deviation from the law, then base, terms, record of each run.
    deviating: Vec<Products>,
    priors: Products,
    /// What the runs' stirred states cost in evidence.
    log_occam: f64,
}

impl<'a> Joint<'a> {
    pub(in crate::diagnosis) fn new(
        survey: &'a Survey,
        fit: &'a Fit,
        summaries: &[Summary],
    ) -> Self {
        let layout = Layout::new(survey, fit);
        let places = (0..survey.runs.len()).map(|run| layout.places(survey, fit, run)).collect();
        let each = summaries.iter().enumerate();
        let deviating = each.map(|(run, summary)| deviating(survey, fit, run, summary)).collect();
        let mut priors = Products::zero(layout.n + 1);
        add_priors(survey, fit, &layout, &mut priors);
        let log_occam = summaries.iter().map(|summary| summary.log_occam).sum();
        Self { survey, fit, layout, places, deviating, priors, log_occam }
    }

    /// A candidate of a run beside its deviation from the law, base, terms and record.
    pub(in crate::diagnosis) fn deviating_side(&self, run: usize, candidate: &Side) -> Side {
        let n = self.deviating[run].n();
        let mut side = Side::zero(candidate.among.n(), n);
        side.gather(candidate, 0, &deviating_places(self.survey, self.fit, run, n));
        side
    }

    /// Every run with its scatter eliminated, and the products of all of them with the priors.
    pub(in crate::diagnosis) fn gathered(&self, scatter: &Scatter) -> (Vec<Marginal>, Products) {
        let each = self.deviating.iter().enumerate();
        let marginals: Vec<Marginal> = each
            .map(|(run, own)| marginal(self.survey, self.fit, run, own.clone(), scatter))
            .collect();
        let mut all = self.priors.clone();
        for (marginal, places) in marginals.iter().zip(&self.places) {
            all.gather(&marginal.eliminated.rest, places);
        }
        (marginals, all)
    }

    /// Solves for one scatter.
    pub(in crate::diagnosis) fn solve(&self, scatter: Scatter) -> Solution {
        let fit = self.fit;
        let (marginals, all) = self.gathered(&scatter);
        let misfit_here = all.at(self.layout.n, self.layout.n);
        let eliminated = all.eliminate(self.layout.n);
        let least_misfit = eliminated.rest.at(0, 0);
        let mut log_evidence = self.log_occam;
        log_evidence -= 0.5 * (least_misfit + eliminated.log_determinant);
        log_evidence += marginals.iter().map(|m| m.log_occam).sum::<f64>();
        for extension in &fit.extensions {
            for k in 0..extension.effect.n_parameters() {
                let sd = extension.effect.parameter(k).typical;
                if sd > 0.0 {
                    log_evidence -= extension.slots.len() as f64 * sd.ln();
                }
            }
        }
        let steps = eliminated.back(&[]);
        Solution {
            scatter,
            log_evidence,
            least_misfit,
            misfit_here,
            steps,
            covariance: Vec::new(),
            eliminated,
            marginals,
        }
    }
}

/// One more reading of a number: its prior, given where the number stands.
pub(super) fn add_prior(all: &mut Products, column: usize, off_centre: f64, sd: f64) {
    let (record, precision) = (all.n() - 1, sd.powi(-2));
    all.add(column, column, precision);
    all.add(column, record, -precision * off_centre);
    all.add(record, record, precision * off_centre * off_centre);
}

fn add_priors(survey: &Survey, fit: &Fit, layout: &Layout, all: &mut Products) {
    for (c, law) in fit.laws.iter().enumerate() {
        let sd = KAPPA_SD * survey.usual_damping_per_s(c);
        add_prior(all, N_LAW * c + 2, law.numbers[2], sd);
        add_prior(all, N_LAW * c + 3, law.numbers[3], 20.0);
    }
    add_prior(all, layout.scale(), fit.log_scale, LOG_SCALE_SD);
    for (e, extension) in fit.extensions.iter().enumerate() {
        for (s, values) in extension.slots.iter().enumerate() {
            for (k, value) in values.iter().enumerate() {
                let sd = extension.effect.parameter(k).typical;
                if sd > 0.0 {
                    let column = layout.parameter(fit, e, s, k);
                    add_prior(all, column, value - extension.centres[s][k], sd);
                }
            }
        }
    }
}

/// Sum of the squares of the priors' readings, and of the runs' deviations from their laws.
pub(super) fn prior_misfit(survey: &Survey, fit: &Fit, scatter: &Scatter) -> f64 {
    let layout = Layout::new(survey, fit);
    let mut all = Products::zero(layout.n + 1);
    add_priors(survey, fit, &layout, &mut all);
    let of_run = |run: usize| -> f64 {
        let sds = spread(survey, fit, run, scatter);
        deviation(survey, fit, run).iter().zip(sds).map(|(d, sd)| (d / sd).powi(2)).sum()
    };
    all.at(layout.n, layout.n) + (0..survey.runs.len()).map(of_run).sum::<f64>()
}

/// The campaign solved about where it stands.
#[derive(Clone)]
pub(in crate::diagnosis) struct Solution {
    pub(in crate::diagnosis) scatter: Scatter,
    pub(in crate::diagnosis) log_evidence: f64,
    /// Least misfit that the linearised model reaches.
    pub(in crate::diagnosis) least_misfit: f64,
    /// Misfit where it stands.
    pub(super) misfit_here: f64,
    /// Steps of the campaign's numbers.
    pub(super) steps: Vec<f64>,
    /// Their covariance.
    pub(in crate::diagnosis) covariance: Vec<Vec<f64>>,
    /// The campaign's numbers eliminated.
    pub(in crate::diagnosis) eliminated: Eliminated,
    pub(in crate::diagnosis) marginals: Vec<Marginal>,
}

/// Solves for one scatter.
pub(in crate::diagnosis) fn solve(
    survey: &Survey,
    fit: &Fit,
    summaries: &[Summary],
    scatter: Scatter,
) -> Solution {
    Joint::new(survey, fit, summaries).solve(scatter).with_covariance()
}

/// The solution of the likeliest scatter, and the evidence of all of them together.
pub(super) fn solve_best(survey: &Survey, fit: &Fit, summaries: &[Summary]) -> (Solution, f64) {
    let joint = Joint::new(survey, fit, summaries);
    let mut best: Option<Solution> = None;
    let mut logs = Vec::new();
    for scatter in scatters(survey) {
        let solution = joint.solve(scatter);
        logs.push(solution.log_evidence);
        if best.as_ref().is_none_or(|b| solution.log_evidence > b.log_evidence) {
            best = Some(solution);
        }
    }
    let best = best.expect("there is a scatter");
    (best.with_covariance(), log_mean_exp(&logs))
}

/// Logarithm of the mean of exponentials.
pub(in crate::diagnosis) fn log_mean_exp(logs: &[f64]) -> f64 {
    let top = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !top.is_finite() {
        return top;
    }
    top + (logs.iter().map(|l| (l - top).exp()).sum::<f64>() / logs.len() as f64).ln()
}

/// The fit moved by a share of the solution's step.
pub(in crate::diagnosis) fn moved(
    survey: &Survey,
    fit: &Fit,
    summaries: &[Summary],
    solution: &Solution,
    share: f64,
) -> Fit {
    let layout = Layout::new(survey, fit);
    let mut next = fit.clone();
    let steps: Vec<f64> = solution.steps.iter().map(|s| s * share).collect();
    for (c, law) in next.laws.iter_mut().enumerate() {
        law.numbers.iter_mut().enumerate().for_each(|(k, number)| *number += steps[N_LAW * c + k]);
    }
    next.log_scale += steps[layout.scale()];
    next.extensions = moved_extensions(fit, &layout, &steps);
    for (run, (summary, marginal)) in summaries.iter().zip(&solution.marginals).enumerate() {
        let local = Layout::local(&layout.places(survey, fit, run), &solution.steps);
        next.states[run] = moved_state(survey, fit, run, summary, marginal, &local, share);
        next.states[run].base.log_scale = next.log_scale;
    }
    next
}

/// The fit with every run's own numbers at their best, those of the campaign as they are.
pub(in crate::diagnosis) fn followed(
    survey: &Survey,
    fit: &Fit,
    summaries: &[Summary],
    scatter: &Scatter,
) -> Fit {
    let joint = Joint::new(survey, fit, summaries);
    let (marginals, _) = joint.gathered(scatter);
    let mut next = fit.clone();
    for (run, (summary, marginal)) in summaries.iter().zip(&marginals).enumerate() {
        let still = vec![0.0; joint.places[run].len()];
        next.states[run] = moved_state(survey, fit, run, summary, marginal, &still, 1.0);
    }
    next
}

/// The parameters of the effects after a step.
pub(super) fn moved_extensions(fit: &Fit, layout: &Layout, steps: &[f64]) -> Vec<Extension> {
    let mut extensions = fit.extensions.clone();
    for (e, extension) in extensions.iter_mut().enumerate() {
        for (s, values) in extension.slots.iter_mut().enumerate() {
            for (k, value) in values.iter_mut().enumerate() {
                let [low, high] = extension.effect.parameter(k).range;
                let margin = if k < extension.effect.strengths.len() { high - low } else { 0.0 };
                let step = steps[layout.parameter(fit, e, s, k)];
                *value = (*value + step).clamp(low - margin, high + margin);
            }
        }
    }
    extensions
}

/// Where a run stands after a share of what steps of the campaign's numbers are to it.
pub(super) fn moved_state(
    survey: &Survey,
    fit: &Fit,
    run: usize,
    summary: &Summary,
    marginal: &Marginal,
    local: &[f64],
    share: f64,
) -> RunState {
    let deviates = marginal.eliminated.back(local);
    let now = deviation(survey, fit, run);
    let mut whole = local.to_vec();
    for i in 0..N_DEVIATIONS {
        whole[i] += deviates[i] - now[i];
    }
    let own = summary.eliminated.back(&whole);
    let mut state = fit.states[run].clone();
    // A run that had no such state yet begins with none stirred.
    state.own.resize(own.len(), 0.0);
    state.own.iter_mut().zip(&own).for_each(|(number, step)| *number += share * step);
    state.base.natural_rad_s += share * whole[0];
    state.base.b1_per_s += share * whole[1];
    state.base.b3_s += share * whole[2];
    state
}

impl Solution {
    fn with_covariance(mut self) -> Self {
        self.covariance = self.eliminated.covariance();
        self
    }

    /// Largest change of a run's deviation from its law that the solution asks for, squared, in
    /// units of the scatter.
    pub(super) fn unsettled(&self, survey: &Survey, fit: &Fit) -> f64 {
        let layout = Layout::new(survey, fit);
        let mut most = 0.0_f64;
        for (run, marginal) in self.marginals.iter().enumerate() {
            let local = Layout::local(&layout.places(survey, fit, run), &self.steps);
            let to = marginal.eliminated.back(&local);
            let now = deviation(survey, fit, run);
            let sds = spread(survey, fit, run, &self.scatter);
            for i in 0..3 {
                most = most.max(((to[i] - now[i]) / sds[i]).powi(2));
            }
        }
        most
    }
}
