//! Causes that a record shows by itself: its steps, and lines in its noise.

use super::survey::Survey;
use super::verdict::Cause;
use crate::inverse::estimate::Estimate;
use crate::model::effects;
use crate::model::{Acts, Effect, Seen};

/// Least logarithm of a Bayes factor over all runs.
const SURE: f64 = 14.0;

/// The causes that the records show, where the runs that can show one do.
pub(super) fn causes(survey: &Survey) -> Vec<Cause> {
    let mut found: Vec<(f64, Cause, bool)> = Vec::new();
    for effect in effects::all() {
        let Acts::Record(sees) = effect.acts else { continue };
        let able = survey.runs.iter().filter(|run| (effect.shows)(&run.at));
        let seen: Vec<Option<Seen>> = able.map(|run| sees(&run.facts)).collect();
        let total: f64 = seen.iter().flatten().map(|s| s.log_bayes_factor).sum();
        let n_seen = seen.iter().flatten().filter(|s| s.log_bayes_factor > 0.0).count();
        let is_line = effect.strengths.iter().any(|p| p.unit == "Hz");
        // A line belongs to the chain and shows in most of its records, not in one.
        if total > SURE && (!is_line || 2 * n_seen >= seen.len()) {
            found.push((total, cause(effect, &seen, total), is_line));
        }
    }
    // One line has one cause: the one that explains it in more runs, the first of equals.
    let best_line = found.iter().filter(|f| f.2).map(|f| f.0).fold(f64::NEG_INFINITY, f64::max);
    let mut line_told = false;
    let mut causes = Vec::new();
    for (total, cause, is_line) in found {
        if !is_line {
            causes.push(cause);
        } else if !line_told && total > 0.95 * best_line {
            line_told = true;
            causes.push(cause);
        }
    }
    causes
}

fn cause(effect: &'static Effect, seen: &[Option<Seen>], total: f64) -> Cause {
    let parameters = effect
        .strengths
        .iter()
        .enumerate()
        .map(|(k, parameter)| {
            let values: Vec<(f64, f64)> =
                seen.iter().flatten().filter_map(|s| s.values.get(k).copied()).collect();
            let weight: f64 = values.iter().map(|(_, sd)| sd.powi(-2)).sum();
            let mean = values.iter().map(|(v, sd)| v * sd.powi(-2)).sum::<f64>() / weight;
            (parameter.symbol, parameter.unit, Estimate::normal(mean, weight.sqrt().recip()))
        })
        .collect();
    Cause {
        effect: effect.id,
        equation: effect.equation,
        log_bayes_factor: total,
        parameters,
        equivalent_to: Vec::new(),
    }
}
