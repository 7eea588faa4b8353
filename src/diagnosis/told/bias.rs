//! What the base model says of the damping, and what the extended one does.

use super::change::Change;
use crate::diagnosis::fit::settle::Settled;
use crate::diagnosis::fit::survey::{N_LAW, Survey};
use crate::diagnosis::search::growth::Grown;
use crate::inverse::estimate::Estimate;

/// What the base model says of the damping, and what the extended one does.
#[derive(Debug, Clone, PartialEq)]
pub struct Bias {
    /// Condition.
    pub condition: String,
    /// Linear damping at rest [1/s].
    pub b1_per_s: Change,
    /// Cubic damping [s].
    pub b3_s: Change,
    /// Speed coefficient [-]; none without runs at different speeds.
    pub kappa: Option<Change>,
}

/// The bias of every condition.
pub(super) fn bias(survey: &Survey, grown: &Grown) -> Vec<Bias> {
    let told = survey.conditions.iter().enumerate().map(|(c, condition)| {
        let number = |settled: &Settled, k: usize| {
            let column = N_LAW * c + k;
            let sd = settled.solution.covariance[column][column].max(0.0).sqrt();
            Estimate::normal(settled.fit.laws[c].numbers[k], sd)
        };
        let change =
            |k: usize| Change { before: number(&grown.base, k), after: number(&grown.last, k) };
        let members = survey.members(c);
        let first = survey.runs[members[0]].at.froude;
        let moves = members.iter().any(|r| (survey.runs[*r].at.froude - first).abs() > 1e-3);
        Bias {
            condition: condition.clone(),
            b1_per_s: change(1),
            b3_s: change(3),
            kappa: moves
                .then(|| Change { before: kappa(&grown.base, c), after: kappa(&grown.last, c) }),
        }
    });
    told.collect()
}

/// The ratio `bk/b0` with its deviation to first order.
fn kappa(settled: &Settled, condition: usize) -> Estimate {
    let (zero, slope) = (N_LAW * condition + 1, N_LAW * condition + 2);
    let [_, b0, bk, _] = settled.fit.laws[condition].numbers;
    let covariance = &settled.solution.covariance;
    let kappa = bk / b0;
    let variance = covariance[slope][slope] - 2.0 * kappa * covariance[zero][slope]
        + kappa * kappa * covariance[zero][zero];
    Estimate::normal(kappa, variance.max(0.0).sqrt() / b0.abs())
}
