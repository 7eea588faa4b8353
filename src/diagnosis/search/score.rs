//! The score test: how much every effect of the table would explain, in one pass.

use crate::diagnosis::fit::elimination::{Eliminated, Products, Side};
use crate::diagnosis::fit::run_fit::ChannelNoise;
use crate::diagnosis::fit::scatter::scatters;
use crate::diagnosis::fit::solve::{Joint, Solution, log_mean_exp};
use crate::diagnosis::fit::survey::{Extension, Fit, Survey};
use crate::model::effects;
use crate::model::{Acts, Effect, Scope, Term};

/// One effect with what it promises.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Scored {
    /// Logarithm of the Bayes factor for adding it, linearised.
    pub(super) log_bayes_factor: f64,
    /// The effect with the strengths that the linearised model gives it.
    pub(in crate::diagnosis) extension: Extension,
}

/// What is tried on a model: effects and laws that some run shows, that are not in it and not
/// banned.
fn tried(survey: &Survey, fit: &Fit, banned: &[&str]) -> Vec<&'static Effect> {
    let known = |id: &str| fit.extensions.iter().any(|e| e.effect.id == id);
    let mut kept: Vec<&'static Effect> = Vec::new();
    for effect in effects::weighed() {
        let shown = survey.runs.iter().any(|run| (effect.shows)(&run.at));
        let twin = effect
            .always_equivalent
            .iter()
            .any(|id| known(id) || kept.iter().any(|kept| kept.id == *id));
        // The reading of a twin is the one that disturbs no equation.
        let twins = effect.always_equivalent;
        let stands_back = !twins.is_empty()
            && !matches!(effect.acts, Acts::Roll(_))
            && !twins.iter().any(|id| banned.contains(id));
        let seen = matches!(effect.acts, Acts::Record(_));
        let is_free = !banned.contains(&effect.id) && !known(effect.id);
        if shown && !twin && !stands_back && !seen && is_free {
            kept.push(effect);
        }
    }
    kept
}

/// One candidate: an effect with one of its shapes.
#[derive(Clone)]
struct Candidate {
    effect: &'static Effect,
    term: Term,
}

fn candidates(effects: &[&'static Effect], run: &crate::model::Circumstances) -> Vec<Candidate> {
    let mut all = Vec::new();
    for effect in effects {
        for shape in (effect.nodes)(run) {
            let mut values = vec![0.0; effect.strengths.len()];
            values.extend(shape);
            all.push(Candidate { effect, term: Term { effect, values } });
        }
    }
    all
}

/// What one set of columns brings.
struct Brought {
    log_bayes_factor: f64,
    strengths: Vec<f64>,
}

/// Logarithm of a Bayes factor that no runs give: the model has run away from them.
const RUNAWAY: f64 = 1e12;

/// Scores every effect that is not in the model yet, best first.
pub(in crate::diagnosis) fn score(
    survey: &Survey,
    fit: &Fit,
    noise: &[ChannelNoise],
) -> Vec<Scored> {
    score_all_but(&[], survey, fit, noise)
}

/// The same without those that are banned, whose twins are tried in their place.
pub(super) fn score_all_but(
    banned: &[&str],
    survey: &Survey,
    fit: &Fit,
    noise: &[ChannelNoise],
) -> Vec<Scored> {
    let tried = tried(survey, fit, banned);
    let (own, common): (Vec<_>, Vec<_>) =
        tried.into_iter().partition(|effect| effect.scope.is_of_each_run());
    let largest = (0..survey.runs.len())
        .max_by(|a, b| {
            survey.runs[*a].at.amplitude_rad.total_cmp(&survey.runs[*b].at.amplitude_rad)
        })
        .unwrap_or(0);
    let common = candidates(&common, &survey.runs[largest].at);
    let own: Vec<Vec<Candidate>> = survey
        .runs
        .iter()
        .map(|run| {
            let shown: Vec<_> = own.iter().copied().filter(|e| (e.shows)(&run.at)).collect();
            candidates(&shown, &run.at)
        })
        .collect();
    let summaries = survey.summaries(fit, noise, &|r| {
        common.iter().chain(&own[r]).map(|candidate| candidate.term.clone()).collect()
    });
    let joint = Joint::new(survey, fit, &summaries);
    let sides: Vec<Vec<Side>> = summaries
        .iter()
        .enumerate()
        .map(|(r, run)| run.candidates.iter().map(|c| joint.deviating_side(r, c)).collect())
        .collect();
    let mut logs: Vec<Vec<f64>> = vec![Vec::new(); common.len()];
    let mut own_logs: Vec<Vec<Vec<f64>>> =
        own.iter().map(|all| vec![Vec::new(); all.len()]).collect();
    let mut best_strengths: Vec<(f64, Vec<f64>)> =
        vec![(f64::NEG_INFINITY, Vec::new()); common.len()];
    let mut own_strengths: Vec<Vec<(f64, Vec<f64>)>> =
        own.iter().map(|all| vec![(f64::NEG_INFINITY, Vec::new()); all.len()]).collect();
    let mut base_logs = Vec::new();
    for scatter in scatters(survey) {
        let solution = joint.solve(scatter);
        let base = solution.log_evidence;
        base_logs.push(base);
        for (c, candidate) in common.iter().enumerate() {
            let side = common_side(survey, &joint, &solution, candidate, |r| &sides[r][c]);
            let brought = bring(&solution.eliminated, &side, candidate.effect);
            logs[c].push(base + brought.log_bayes_factor);
            if base + brought.log_bayes_factor > best_strengths[c].0 {
                best_strengths[c] = (base + brought.log_bayes_factor, brought.strengths);
            }
        }
        for (r, own) in own.iter().enumerate() {
            for (c, candidate) in own.iter().enumerate() {
                let mut side = Side::zero(candidate.effect.strengths.len(), joint.layout.n + 1);
                let own = solution.marginals[r].eliminated.beside(&sides[r][common.len() + c]);
                side.gather(&own, 0, &joint.places[r]);
                let brought = bring(&solution.eliminated, &side, candidate.effect);
                own_logs[r][c].push(brought.log_bayes_factor);
                if base + brought.log_bayes_factor > own_strengths[r][c].0 {
                    own_strengths[r][c] = (base + brought.log_bayes_factor, brought.strengths);
                }
            }
        }
    }
    let none = log_mean_exp(&base_logs);
    let mut scored = common_scores(survey, &common, &logs, &best_strengths, none);
    scored.extend(own_scores(survey, &own, &own_logs, &own_strengths, &base_logs, none));
    scored.retain(|one| one.log_bayes_factor < RUNAWAY);
    scored.sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
    scored
}

/// A candidate of all runs beside the campaign's columns: one copy, or one for every condition.
fn common_side<'s>(
    survey: &Survey,
    joint: &Joint<'_>,
    solution: &Solution,
    candidate: &Candidate,
    of_run: impl Fn(usize) -> &'s Side,
) -> Side {
    let n = candidate.effect.strengths.len();
    let is_shared = candidate.effect.scope == Scope::Campaign;
    let copies = if is_shared { 1 } else { survey.conditions.len() };
    let mut side = Side::zero(n * copies, joint.layout.n + 1);
    for (r, marginal) in solution.marginals.iter().enumerate() {
        if (candidate.effect.shows)(&survey.runs[r].at) {
            let copy = if is_shared { 0 } else { survey.condition_of[r] };
            side.gather(&marginal.eliminated.beside(of_run(r)), n * copy, &joint.places[r]);
        }
    }
    side
}

/// Adds columns with their priors to what the model leaves.
fn bring(known: &Eliminated, side: &Side, effect: &Effect) -> Brought {
    let left = known.beside(side);
    let n = left.among.n();
    let mut products = Products::zero(n + 1);
    let mut log_precision = 0.0;
    for i in 0..n {
        for j in i..n {
            products.add(i, j, left.among.at(i, j));
        }
        products.add(i, n, left.with(i, 0));
        let sd = effect.strengths[i % effect.strengths.len()].typical;
        products.add(i, i, sd.powi(-2));
        log_precision -= 2.0 * sd.ln();
    }
    let eliminated = products.eliminate(n);
    let gain = -eliminated.rest.at(0, 0);
    Brought {
        log_bayes_factor: 0.5 * (gain - eliminated.log_determinant + log_precision),
        strengths: eliminated.back(&[]),
    }
}

fn extension(
    survey: &Survey,
    candidate: &Candidate,
    strengths: &[f64],
    slot_of: Vec<Option<usize>>,
) -> Extension {
    let n = candidate.effect.strengths.len();
    let slots: Vec<Vec<f64>> = strengths
        .chunks(n)
        .map(|own| own.iter().chain(&candidate.term.values[n..]).copied().collect())
        .collect();
    let centres = slots
        .iter()
        .map(|values| (0..values.len()).map(|k| if k < n { 0.0 } else { values[k] }).collect())
        .collect();
    debug_assert_eq!(slot_of.len(), survey.runs.len());
    Extension { effect: candidate.effect, slots, centres, slot_of }
}

fn common_scores(
    survey: &Survey,
    common: &[Candidate],
    logs: &[Vec<f64>],
    strengths: &[(f64, Vec<f64>)],
    none: f64,
) -> Vec<Scored> {
    let mut scored = Vec::new();
    let mut start = 0;
    while start < common.len() {
        let effect = common[start].effect;
        let end = start + common[start..].iter().take_while(|c| c.effect.id == effect.id).count();
        let each: Vec<f64> = (start..end).map(|c| log_mean_exp(&logs[c])).collect();
        let best = (start..end).max_by(|a, b| strengths[*a].0.total_cmp(&strengths[*b].0));
        let best = best.unwrap_or(start);
        let slot_of = (0..survey.runs.len())
            .map(|r| {
                let slot = if effect.scope == Scope::Campaign { 0 } else { survey.condition_of[r] };
                (effect.shows)(&survey.runs[r].at).then_some(slot)
            })
            .collect();
        let log_bayes_factor = log_mean_exp(&each) - none;
        // An effect that drives the equation out of the numbers explains nothing.
        if log_bayes_factor.is_finite() && !strengths[best].1.is_empty() {
            let extension = extension(survey, &common[best], &strengths[best].1, slot_of);
            scored.push(Scored { log_bayes_factor, extension });
        }
        start = end;
    }
    scored
}

/// What an effect of one run's own promises there.
struct Own {
    run: usize,
    /// Place of its best shape among the candidates of the run.
    best: usize,
    /// Logarithm of the Bayes factor under each scatter.
    per_scatter: Vec<f64>,
    /// The same over all scatters.
    log: f64,
}

/// Logarithm of the Bayes factor of a run's own effect from which the run has it.
const HAS_IT: f64 = 1.0;

/// Effects that each run has of its own: any run may have it or not, of some only few.
fn own_scores(
    survey: &Survey,
    own: &[Vec<Candidate>],
    logs: &[Vec<Vec<f64>>],
    strengths: &[Vec<(f64, Vec<f64>)>],
    base_logs: &[f64],
    none: f64,
) -> Vec<Scored> {
    let mut effects: Vec<&'static Effect> = Vec::new();
    for candidate in own.iter().flatten() {
        if !effects.iter().any(|known| known.id == candidate.effect.id) {
            effects.push(candidate.effect);
        }
    }
    let of_run = |effect: &Effect, run: usize| -> Option<Own> {
        let nodes: Vec<usize> = (0..own[run].len())
            .filter(|c| own[run][*c].effect.id == effect.id && !strengths[run][*c].1.is_empty())
            .collect();
        let place = |c: &usize| strengths[run][*c].0;
        let best = nodes.iter().copied().max_by(|a, b| place(a).total_cmp(&place(b)))?;
        let per_scatter: Vec<f64> = (0..base_logs.len())
            .map(|h| log_mean_exp(&nodes.iter().map(|c| logs[run][*c][h]).collect::<Vec<_>>()))
            .collect();
        let weighted: Vec<f64> =
            per_scatter.iter().zip(base_logs).map(|(log, base)| log + base).collect();
        Some(Own { run, best, log: log_mean_exp(&weighted) - none, per_scatter })
    };
    let mut scored = Vec::new();
    for effect in effects {
        let mut runs: Vec<Own> =
            (0..survey.runs.len()).filter_map(|run| of_run(effect, run)).collect();
        let most = effect.scope.most_runs(survey.runs.len());
        if runs.len() > most {
            runs.sort_by(|a, b| b.log.total_cmp(&a.log));
            runs.truncate(most);
            runs.sort_by_key(|one| one.run);
        }
        let mut totals = base_logs.to_vec();
        let mut slots: Vec<Option<usize>> = vec![None; survey.runs.len()];
        let mut chosen: Option<Extension> = None;
        for Own { run, best, per_scatter, log } in runs {
            // One run in two may have it, whatever the others have.
            for (total, log) in totals.iter_mut().zip(&per_scatter) {
                *total += log_mean_exp(&[0.0, *log]);
            }
            if log > HAS_IT {
                let (candidate, strengths) = (&own[run][best], &strengths[run][best].1);
                let one = extension(survey, candidate, strengths, slots.clone());
                let whole = chosen.get_or_insert_with(|| Extension {
                    slots: Vec::new(),
                    centres: Vec::new(),
                    ..one.clone()
                });
                slots[run] = Some(whole.slots.len());
                whole.slots.extend(one.slots);
                whole.centres.extend(one.centres);
            }
        }
        if let Some(mut extension) = chosen {
            extension.slot_of = slots;
            scored.push(Scored { log_bayes_factor: log_mean_exp(&totals) - none, extension });
        }
    }
    scored
}
