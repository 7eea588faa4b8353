//! Runs of one condition at one speed: how much they differ from run to run.

use serde::Serialize;

use crate::inverse::estimate::Estimate;
use crate::inverse::scattered::{combination, never_nil, nodes};
use crate::results::{COMPARISON_DEG, IdentifiedRun, Results, by_speed};
use crate::run::RunKind;

/// Forced runs whose frequencies differ by a larger share were meant to differ.
const FREQUENCY_APART: f64 = 0.01;

/// The runs of one kind and condition at one speed, forced ones at one frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repeats {
    /// Loading or appendage condition.
    pub condition: String,
    /// Mean Froude number [-].
    pub froude: f64,
    /// Roll amplitude of the damping [deg].
    pub amplitude_deg: f64,
    /// Ids of the runs.
    pub runs: Vec<String>,
    /// Mean of `b_eq` over the runs [1/s].
    pub mean_per_s: f64,
    /// Standard deviation from run to run [1/s], from two runs up.
    pub run_to_run_per_s: Option<f64>,
    /// Root mean square of the standard deviations that the runs give themselves [1/s].
    pub own_per_s: f64,
    /// `b_eq` of the condition with scatter and noise [1/s], from two runs up.
    pub damping_per_s: Option<Estimate>,
}

/// Decays of each condition at each speed, in order, at the amplitude of comparison.
pub fn repeats(results: &Results) -> Vec<Repeats> {
    repeats_at(results, RunKind::Decay, COMPARISON_DEG)
}

/// The same of the runs of one kind at an amplitude [deg] that they reach.
pub(super) fn repeats_at(results: &Results, kind: RunKind, amplitude_deg: f64) -> Vec<Repeats> {
    let mut all = Vec::new();
    for condition in results.conditions() {
        for mut runs in by_speed(giving(results, kind, condition, amplitude_deg)) {
            let at = |run: &IdentifiedRun| run.identification.rolling_frequency_rad_s();
            if kind == RunKind::Forced {
                runs.sort_by(|a, b| at(a).total_cmp(&at(b)));
            }
            let is_repeat = |a: &&IdentifiedRun, b: &&IdentifiedRun| {
                kind == RunKind::Decay || at(b) <= (1.0 + FREQUENCY_APART) * at(a)
            };
            for runs in runs.chunk_by(is_repeat) {
                all.extend(of(condition, runs, amplitude_deg));
            }
        }
    }
    all
}

/// The decays of a condition that give their damping at an amplitude.
pub(super) fn decays<'r>(
    results: &'r Results,
    condition: &str,
    amplitude_deg: f64,
) -> Vec<&'r IdentifiedRun> {
    giving(results, RunKind::Decay, condition, amplitude_deg)
}

fn giving<'r>(
    results: &'r Results,
    kind: RunKind,
    condition: &str,
    amplitude_deg: f64,
) -> Vec<&'r IdentifiedRun> {
    let runs = results.runs.iter().filter(|run| run.condition == condition);
    let gives = |run: &&IdentifiedRun| damping(run, amplitude_deg).is_some();
    runs.filter(|run| run.run.kind == kind).filter(gives).collect()
}

/// `b_eq` of a run [1/s] at an amplitude, where it is a number; beyond what the run reached, only
/// at the amplitude of comparison.
pub(super) fn damping(run: &IdentifiedRun, amplitude_deg: f64) -> Option<Estimate> {
    let at = run.at(amplitude_deg)?;
    let is_told = !at.extrapolated || (amplitude_deg - COMPARISON_DEG).abs() < 1e-9;
    let damping = at.fitted_per_s;
    (is_told && damping.mean.is_finite() && damping.sd.is_finite()).then_some(damping)
}

fn of(condition: &str, runs: &[&IdentifiedRun], amplitude_deg: f64) -> Option<Repeats> {
    let values: Vec<(f64, f64)> =
        runs.iter().filter_map(|run| damping(run, amplitude_deg)).map(|b| (b.mean, b.sd)).collect();
    let n = values.len() as f64;
    if values.is_empty() {
        return None;
    }
    let mean_per_s = values.iter().map(|value| value.0).sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value.0 - mean_per_s).powi(2)).sum();
    let own = values.iter().map(|value| value.1.powi(2)).sum::<f64>() / n;
    let repeated = values.len() > 1;
    let damping_per_s = || {
        let nodes = nodes(&vec![vec![1.0]; values.len()], &values);
        combination(&never_nil(nodes, &values), &[1.0])
    };
    Some(Repeats {
        condition: condition.to_owned(),
        froude: runs.iter().map(|run| run.froude).sum::<f64>() / runs.len() as f64,
        amplitude_deg,
        runs: runs.iter().map(|run| run.id.clone()).collect(),
        mean_per_s,
        run_to_run_per_s: repeated.then(|| (squares / (n - 1.0)).sqrt()),
        own_per_s: own.sqrt(),
        damping_per_s: repeated.then(damping_per_s),
    })
}
