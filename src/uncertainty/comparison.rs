//! Whether two conditions differ in damping at one speed, with the probability that they do.

use serde::Serialize;

use super::AMPLITUDES_DEG;
use super::repeats::{damping, decays};
use crate::inverse::estimate::Estimate;
use crate::inverse::scattered::{Node, combination, never_nil, nodes, probability_positive};
use crate::results::{FROUDE_APART, IdentifiedRun, Results, by_speed};

/// Where the scatter from run to run is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Runs that were repeated at one condition and speed.
    Repeats,
    /// What the runs of a condition leave of `b_eq = c0 + c2 Fr^2`.
    Law,
    /// Nothing: every run is alone.
    Nothing,
}

/// Two conditions at one Froude number.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The first.
    pub first: String,
    /// The second.
    pub second: String,
    /// Froude number at which both were run [-].
    pub froude: f64,
    /// Roll amplitude of the damping [deg].
    pub amplitude_deg: f64,
    /// `b_eq` of the second less that of the first [1/s]; none where it can't be told.
    pub difference_per_s: Option<Estimate>,
    /// The same over that of the first [-].
    pub difference_share: Option<Estimate>,
    /// Posterior probability that the second has the larger damping [-].
    pub probability_larger: Option<f64>,
    /// Where the scatter from run to run is known from.
    pub basis: Basis,
}

/// Degrees of freedom from which repeats alone tell the scatter.
const N_FREE: usize = 3;

/// A condition with its decays, scaled by its mean so that one relative scatter fits all.
struct Condition<'r> {
    name: &'r str,
    amplitude_deg: f64,
    /// The runs, by speed.
    speeds: Vec<Vec<&'r IdentifiedRun>>,
    mean_per_s: f64,
}

impl Condition<'_> {
    fn n_runs(&self) -> usize {
        self.speeds.iter().map(Vec::len).sum()
    }
}

/// Every pair of conditions at each Froude number at which both were run, by amplitude.
///
/// `b_eq` of a run over the mean of its condition is the condition's value at the speed, plus a
/// scatter from run to run that is alike everywhere, plus the run's own noise. The scatter is
/// unknown, scale-free together with the noise, and it is integrated out, so that few repeats make
/// wide intervals and not bold claims.
pub fn comparisons(results: &Results) -> Vec<Comparison> {
    AMPLITUDES_DEG.into_iter().flat_map(|amplitude_deg| at(results, amplitude_deg)).collect()
}

fn at(results: &Results, amplitude_deg: f64) -> Vec<Comparison> {
    let names = results.conditions().into_iter();
    let all: Vec<Condition<'_>> =
        names.filter_map(|name| condition(results, name, amplitude_deg)).collect();
    let n_runs: usize = all.iter().map(Condition::n_runs).sum();
    let n_groups: usize = all.iter().map(|condition| condition.speeds.len()).sum();
    let n_free = n_runs - n_groups;
    let with_law = all.iter().all(|condition| condition.speeds.len() >= 3);
    let basis = match n_free {
        N_FREE.. => Basis::Repeats,
        _ if with_law && !all.is_empty() => Basis::Law,
        1.. => Basis::Repeats,
        0 => Basis::Nothing,
    };
    let fitted = (basis != Basis::Nothing).then(|| fit(&all, basis));
    let mut comparisons = Vec::new();
    for (i, first) in all.iter().enumerate() {
        for (j, second) in all.iter().enumerate().skip(i + 1) {
            for (k, runs) in first.speeds.iter().enumerate() {
                let froude = mean_froude(runs);
                let same = |runs: &Vec<_>| (mean_froude(runs) - froude).abs() <= FROUDE_APART;
                let Some(l) = second.speeds.iter().position(same) else { continue };
                let at = |condition, speed| columns(&all, basis, condition, speed);
                let told = fitted.as_ref().map(|nodes| {
                    told(nodes, (&at(i, k), first.mean_per_s), (&at(j, l), second.mean_per_s))
                });
                comparisons.push(Comparison {
                    first: first.name.to_owned(),
                    second: second.name.to_owned(),
                    froude,
                    amplitude_deg,
                    difference_per_s: told.map(|told| told.0),
                    difference_share: told.map(|told| told.1),
                    probability_larger: told.map(|told| told.2),
                    basis,
                });
            }
        }
    }
    comparisons
}

fn condition<'r>(results: &'r Results, name: &'r str, amplitude_deg: f64) -> Option<Condition<'r>> {
    let runs = decays(results, name, amplitude_deg);
    let values: Vec<f64> =
        runs.iter().filter_map(|run| Some(damping(run, amplitude_deg)?.mean)).collect();
    let mean_per_s = values.iter().sum::<f64>() / values.len().max(1) as f64;
    (mean_per_s > 0.0).then(|| Condition {
        name,
        amplitude_deg,
        speeds: by_speed(runs),
        mean_per_s,
    })
}

fn mean_froude(runs: &[&IdentifiedRun]) -> f64 {
    runs.iter().map(|run| run.froude).sum::<f64>() / runs.len() as f64
}

fn fit(all: &[Condition<'_>], basis: Basis) -> Vec<Node> {
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for (i, condition) in all.iter().enumerate() {
        for (k, runs) in condition.speeds.iter().enumerate() {
            for damping in runs.iter().filter_map(|run| damping(run, condition.amplitude_deg)) {
                rows.push(columns(all, basis, i, k));
                let scale = condition.mean_per_s;
                values.push((damping.mean / scale, damping.sd / scale));
            }
        }
    }
    never_nil(nodes(&rows, &values), &values)
}

/// The row of a run at a speed of a condition: which coefficients its mean is made of.
fn columns(all: &[Condition<'_>], basis: Basis, condition: usize, speed: usize) -> Vec<f64> {
    let mut row = Vec::new();
    for (i, other) in all.iter().enumerate() {
        let is_it = f64::from(u8::from(i == condition));
        if basis == Basis::Law {
            let froude = mean_froude(&all[condition].speeds[speed]);
            row.extend([is_it, is_it * froude.powi(2)]);
        } else {
            row.extend((0..other.speeds.len()).map(|k| if k == speed { is_it } else { 0.0 }));
        }
    }
    row
}

/// Difference, its share of the first, and the probability that it is positive.
fn told(
    nodes: &[Node],
    (first, first_per_s): (&[f64], f64),
    (second, second_per_s): (&[f64], f64),
) -> (Estimate, Estimate, f64) {
    let weights: Vec<f64> =
        first.iter().zip(second).map(|(a, b)| second_per_s * b - first_per_s * a).collect();
    let difference = combination(nodes, &weights);
    let of_first = first_per_s * combination(nodes, first).mean;
    (difference, difference.scaled(1.0 / of_first), probability_positive(nodes, &weights))
}
