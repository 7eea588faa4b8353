//! How far the damping of decays rises with the roll, speed by speed, whatever its law.
//!
//! The fitted law is used only to move half cycles to the amplitude that they are near.

use crate::inverse::decay::half_cycles::NEAR;
use crate::inverse::estimate::Estimate;
use crate::results::{IdentifiedRun, Results, by_speed};
use crate::run::RunKind;

/// Rise of `b_eq` between two roll amplitudes in the decays of a condition at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Rise {
    /// Loading or appendage condition.
    pub condition: String,
    /// Mean Froude number [-].
    pub froude: f64,
    /// Number of decays that reach both amplitudes.
    pub n_runs: usize,
    /// The smaller and the larger roll amplitude [deg].
    pub amplitudes_deg: [f64; 2],
    /// `b_eq` from half cycles about the larger amplitude less that about the smaller [1/s], with
    /// what the noise of the runs leaves unsure; the scatter from run to run is not in it.
    pub rise_per_s: Estimate,
}

/// Least ratio of the amplitudes [-]: nearer ones share half cycles, and their errors.
const APART: f64 = NEAR[1] / NEAR[0];

/// The rise of `b_eq` at each speed of the conditions whose decays reach the same two amplitudes at
/// two speeds or more: those that most speeds reach, as far apart as these allow.
pub fn rises(results: &Results) -> Vec<Rise> {
    let of = |condition: &str| {
        let runs = results.runs.iter().filter(|run| run.condition == condition);
        let decays = runs.filter(|run| run.run.kind == RunKind::Decay).collect();
        of_condition(condition, &by_speed(decays))
    };
    results.conditions().into_iter().flat_map(of).collect()
}

fn of_condition(condition: &str, speeds: &[Vec<&IdentifiedRun>]) -> Vec<Rise> {
    let all = speeds.iter().flatten().flat_map(|run| &run.identification.equivalent_damping);
    let mut amplitudes_deg: Vec<f64> = all.map(|at| at.amplitude_deg).collect();
    amplitudes_deg.sort_by(f64::total_cmp);
    amplitudes_deg.dedup();
    let mut best: Vec<Rise> = Vec::new();
    for small in &amplitudes_deg {
        for large in amplitudes_deg.iter().filter(|large| **large >= APART * small) {
            let between = [*small, *large];
            let rises: Vec<Rise> =
                speeds.iter().filter_map(|runs| at_speed(condition, runs, between)).collect();
            let span = |rises: &[Rise]| {
                rises.first().map_or(0.0, |rise| rise.amplitudes_deg[1] - rise.amplitudes_deg[0])
            };
            let is_better =
                rises.len() > best.len() || rises.len() == best.len() && span(&rises) > span(&best);
            if rises.len() > 1 && is_better {
                best = rises;
            }
        }
    }
    best
}

fn at_speed(condition: &str, runs: &[&IdentifiedRun], amplitudes_deg: [f64; 2]) -> Option<Rise> {
    let rises: Vec<Estimate> = runs.iter().filter_map(|run| of_run(run, amplitudes_deg)).collect();
    let n = rises.len() as f64;
    let mean = rises.iter().map(|rise| rise.mean).sum::<f64>() / n;
    let variance = rises.iter().map(|rise| rise.sd * rise.sd).sum::<f64>() / (n * n);
    (!rises.is_empty()).then(|| Rise {
        condition: condition.to_owned(),
        froude: runs.iter().map(|run| run.froude).sum::<f64>() / runs.len() as f64,
        n_runs: rises.len(),
        amplitudes_deg,
        rise_per_s: Estimate::normal(mean, variance.sqrt()),
    })
}

fn of_run(run: &IdentifiedRun, [small, large]: [f64; 2]) -> Option<Estimate> {
    let at = |deg: f64| {
        let mut all = run.identification.equivalent_damping.iter();
        all.find(|at| (at.amplitude_deg - deg).abs() < 1e-9 && !at.extrapolated)?.local_per_s
    };
    let (small, large) = (at(small)?, at(large)?);
    let rise = Estimate::normal(large.mean - small.mean, large.sd.hypot(small.sd));
    rise.mean.is_finite().then_some(rise)
}
