//! All runs solved together: laws and effects common, each run's scatter about the law marginal.

use super::elimination::{Eliminated, Products};
use super::run_fit::Summary;
use super::survey::{Fit, N_LAW, Survey};

/// How far runs of one condition lie from their law, as shares of its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scatter {
    pub(super) damping: f64,
    pub(super) frequency: f64,
}

/// Scatters that are weighed: from none to that of the seed paper's Table 2 and beyond.
const DAMPING: [f64; 6] = [1e-3, 0.006, 0.02, 0.06, 0.15, 0.35];
const FREQUENCY: [f64; 4] = [1e-5, 5e-4, 2e-3, 1e-2];

/// Every scatter that is weighed; a campaign whose conditions have one run each has none.
pub(super) fn scatters(survey: &Survey) -> Vec<Scatter> {
    let repeats = (0..survey.conditions.len()).any(|c| survey.members(c).len() > 1);
    if !repeats {
        return vec![Scatter { damping: DAMPING[0], frequency: FREQUENCY[0] }];
    }
    let pairs = DAMPING.iter().flat_map(|d| FREQUENCY.iter().map(move |f| (*d, *f)));
    pairs.map(|(damping, frequency)| Scatter { damping, frequency }).collect()
}

const LOG_SCALE_SD: f64 = 0.03;
/// Prior standard deviation of `bk` as a multiple of `b0`: kappa of the seed paper is 12.
const KAPPA_SD: f64 = 30.0;

/// The columns that belong to the campaign: laws, scale, parameters of the extensions.
pub(super) struct Layout {
    n_conditions: usize,
    /// First column of every extension.
    firsts: Vec<usize>,
    /// Number of columns.
    pub(super) n: usize,
}

impl Layout {
    pub(super) fn new(survey: &Survey, fit: &Fit) -> Self {
        let n_conditions = survey.conditions.len();
        let mut n = N_LAW * n_conditions + 1;
        let mut firsts = Vec::new();
        for extension in &fit.extensions {
            firsts.push(n);
            n += extension.slots.len() * extension.effect.n_parameters();
        }
        Self { n_conditions, firsts, n }
    }

    pub(super) fn scale(&self) -> usize {
        N_LAW * self.n_conditions
    }

    /// Column of a parameter of a set of an extension.
    pub(super) fn parameter(&self, fit: &Fit, extension: usize, slot: usize, k: usize) -> usize {
        self.firsts[extension] + slot * fit.extensions[extension].effect.n_parameters() + k
    }

    /// For every column of a run's base and terms, the campaign's columns that move it.
    fn places(&self, survey: &Survey, fit: &Fit, run: usize) -> Vec<Vec<(usize, f64)>> {
        let law = N_LAW * survey.condition_of[run];
        let square = survey.runs[run].at.froude.powi(2);
        let mut places = vec![
            vec![(law, 1.0)],
            vec![(law + 1, 1.0), (law + 2, square)],
            vec![(law + 3, 1.0)],
            vec![(self.scale(), 1.0)],
        ];
        for (e, extension) in fit.extensions.iter().enumerate() {
            if let Some(slot) = extension.slot_of[run] {
                for k in 0..extension.effect.n_parameters() {
                    places.push(vec![(self.parameter(fit, e, slot, k), 1.0)]);
                }
            }
        }
        places
    }
}

/// Deviation of a run from its law: frequency, linear and cubic damping.
fn deviation(survey: &Survey, fit: &Fit, run: usize) -> [f64; 3] {
    let expected = fit.laws[survey.condition_of[run]].at(survey.runs[run].at.froude);
    let base = &fit.states[run].base;
    [base.natural_rad_s - expected[0], base.b1_per_s - expected[1], base.b3_s - expected[2]]
}

/// Standard deviations of a run about its law.
pub(super) fn spread(survey: &Survey, fit: &Fit, run: usize, scatter: &Scatter) -> [f64; 3] {
    let [w, b1, b3] = fit.laws[survey.condition_of[run]].at(survey.runs[run].at.froude);
    // A law that has lost its sign still scatters by a share of a usual damping.
    let size = survey.runs[run].at.b1_per_s;
    let amplitude = survey.runs[run].at.amplitude_rad.max(0.02);
    let b3_size =
        b3.abs().max(0.1 * size / (w * amplitude).powi(2)).min(size / (w * amplitude).powi(2));
    [scatter.frequency * w, scatter.damping * b1.abs().max(0.3 * size), scatter.damping * b3_size]
}

/// One run with its scatter eliminated.
pub(super) struct Marginal {
    pub(super) eliminated: Eliminated,
    log_occam: f64,
}

/// Eliminates a run's deviation from its law; what is left are base, terms, candidates, record.
pub(super) fn marginal(
    survey: &Survey,
    fit: &Fit,
    run: usize,
    summary: &Summary,
    scatter: &Scatter,
) -> Marginal {
    let own = &summary.eliminated.rest;
    let n = own.n();
    let now = deviation(survey, fit, run);
    let places: Vec<Vec<(usize, f64)>> =
        (0..n)
            .map(|i| {
                if i < 3 {
                    vec![(i, 1.0), (3 + i, 1.0), (n + 2, now[i])]
                } else {
                    vec![(3 + i, 1.0)]
                }
            })
            .collect();
    let mut products = Products::zero(n + 3);
    products.gather(own, &places);
    let mut log_precision = 0.0;
    for (i, sd) in spread(survey, fit, run, scatter).into_iter().enumerate() {
        products.add(i, i, sd.powi(-2));
        log_precision -= 2.0 * sd.ln();
    }
    let eliminated = products.eliminate(3);
    let log_occam = -0.5 * (eliminated.log_determinant - log_precision);
    Marginal { eliminated, log_occam }
}

/// Products of all campaign columns, then extra columns, then the record.
pub(super) fn gathered(
    survey: &Survey,
    fit: &Fit,
    layout: &Layout,
    marginals: &[Marginal],
    n_extra: usize,
    extra: &dyn Fn(usize, usize) -> Option<usize>,
) -> Products {
    let n = layout.n + n_extra + 1;
    let mut all = Products::zero(n);
    for (run, marginal) in marginals.iter().enumerate() {
        let rest = &marginal.eliminated.rest;
        let mut places = layout.places(survey, fit, run);
        let n_known = places.len();
        for candidate in 0..rest.n() - 1 - n_known {
            let place = extra(run, candidate);
            places.push(place.map_or(Vec::new(), |at| vec![(layout.n + at, 1.0)]));
        }
        places.push(vec![(n - 1, 1.0)]);
        all.gather(rest, &places);
    }
    add_priors(survey, fit, layout, &mut all);
    all
}

/// One more reading of a number: its prior, given where the number stands.
fn add_prior(all: &mut Products, column: usize, off_centre: f64, sd: f64) {
    let (record, precision) = (all.n() - 1, sd.powi(-2));
    all.add(column, column, precision);
    all.add(column, record, -precision * off_centre);
    all.add(record, record, precision * off_centre * off_centre);
}

fn add_priors(survey: &Survey, fit: &Fit, layout: &Layout, all: &mut Products) {
    for (c, law) in fit.laws.iter().enumerate() {
        let size = survey.runs[survey.members(c)[0]].at.b1_per_s;
        add_prior(all, N_LAW * c + 2, law.numbers[2], KAPPA_SD * size);
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
pub(super) struct Solution {
    pub(super) scatter: Scatter,
    pub(super) log_evidence: f64,
    /// Least misfit that the linearised model reaches.
    pub(super) least_misfit: f64,
    /// Misfit where it stands.
    pub(super) misfit_here: f64,
    /// Steps of the campaign's numbers.
    pub(super) steps: Vec<f64>,
    /// Their covariance.
    pub(super) covariance: Vec<Vec<f64>>,
    marginals: Vec<Marginal>,
}

/// Solves for one scatter.
pub(super) fn solve(
    survey: &Survey,
    fit: &Fit,
    summaries: &[Summary],
    scatter: Scatter,
) -> Solution {
    let layout = Layout::new(survey, fit);
    let marginals: Vec<Marginal> = (0..survey.runs.len())
        .map(|run| {
            let summary = without_candidates(&summaries[run]);
            marginal(survey, fit, run, &summary, &scatter)
        })
        .collect();
    let all = gathered(survey, fit, &layout, &marginals, 0, &|_, _| None);
    let eliminated = all.clone().eliminate(layout.n);
    let least_misfit = eliminated.rest.at(0, 0);
    let mut log_evidence = -0.5 * (least_misfit + eliminated.log_determinant);
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
    let covariance = eliminated.covariance(&all);
    let misfit_here = all.at(layout.n, layout.n);
    Solution { scatter, log_evidence, least_misfit, misfit_here, steps, covariance, marginals }
}

/// The summary without its candidates.
fn without_candidates(summary: &Summary) -> Summary {
    let rest = &summary.eliminated.rest;
    let n_known = rest.n() - 1 - summary.n_candidates;
    let mut kept: Vec<usize> = (0..n_known).collect();
    kept.push(rest.n() - 1);
    let mut slim = summary.clone();
    slim.eliminated.rest = rest.picked(&kept);
    slim.n_candidates = 0;
    slim
}

/// The solution of the likeliest scatter, and the evidence of all of them together.
pub(super) fn solve_best(survey: &Survey, fit: &Fit, summaries: &[Summary]) -> (Solution, f64) {
    let slim: Vec<Summary> = summaries.iter().map(without_candidates).collect();
    let mut best: Option<Solution> = None;
    let mut logs = Vec::new();
    for scatter in scatters(survey) {
        let solution = solve(survey, fit, &slim, scatter);
        logs.push(solution.log_evidence);
        if best.as_ref().is_none_or(|b| solution.log_evidence > b.log_evidence) {
            best = Some(solution);
        }
    }
    let best = best.expect("there is a scatter");
    (best, log_mean_exp(&logs))
}

/// Logarithm of the mean of exponentials.
pub(super) fn log_mean_exp(logs: &[f64]) -> f64 {
    let top = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !top.is_finite() {
        return top;
    }
    top + (logs.iter().map(|l| (l - top).exp()).sum::<f64>() / logs.len() as f64).ln()
}

/// The fit moved by a share of the solution's step.
pub(super) fn moved(
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
    for (e, extension) in next.extensions.iter_mut().enumerate() {
        for (s, values) in extension.slots.iter_mut().enumerate() {
            for (k, value) in values.iter_mut().enumerate() {
                let [low, high] = extension.effect.parameter(k).range;
                let margin = if k < extension.effect.strengths.len() { high - low } else { 0.0 };
                let step = steps[layout.parameter(fit, e, s, k)];
                *value = (*value + step).clamp(low - margin, high + margin);
            }
        }
    }
    for run in 0..survey.runs.len() {
        let places = layout.places(survey, fit, run);
        let local: Vec<f64> = places
            .iter()
            .map(|place| place.iter().map(|(column, by)| by * solution.steps[*column]).sum())
            .collect();
        let deviates = solution.marginals[run].eliminated.back(&local);
        let now = deviation(survey, fit, run);
        let mut whole = local.clone();
        for i in 0..3 {
            whole[i] += deviates[i] - now[i];
        }
        let own = summaries[run].eliminated.back(&whole);
        let state = &mut next.states[run];
        state.own.iter_mut().zip(&own).for_each(|(number, step)| *number += share * step);
        state.base.natural_rad_s += share * whole[0];
        state.base.b1_per_s += share * whole[1];
        state.base.b3_s += share * whole[2];
        state.base.log_scale = next.log_scale;
    }
    next
}

impl Solution {
    /// Largest change of a run's deviation from its law that the solution asks for, squared, in
    /// units of the scatter.
    pub(super) fn unsettled(&self, survey: &Survey, fit: &Fit) -> f64 {
        let layout = Layout::new(survey, fit);
        let mut most = 0.0_f64;
        for (run, marginal) in self.marginals.iter().enumerate() {
            let places = layout.places(survey, fit, run);
            let local: Vec<f64> = places
                .iter()
                .map(|place| place.iter().map(|(column, by)| by * self.steps[*column]).sum())
                .collect();
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
