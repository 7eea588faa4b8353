//! How sure the campaign's numbers are when it is open how far runs lie from their law.

use super::scatter::scatters;
use super::settle::Settled;
use super::solve::Joint;
use super::survey::Survey;

/// Odds against the likeliest scatter below which another does not count.
const LEAST_WEIGHT: f64 = 1e-3;

impl Settled {
    /// The same with the covariance of all scatters, each as probable as its evidence says: four
    /// runs hardly tell how far runs lie from their law.
    pub(in crate::diagnosis) fn over_scatters(mut self, survey: &Survey) -> Self {
        let joint = Joint::new(survey, &self.fit, &self.summaries);
        let best = &self.solution;
        let n = best.steps.len();
        let mut sum = vec![vec![0.0; n]; n];
        let mut whole = 0.0;
        for scatter in scatters(survey) {
            let solution = joint.solve(scatter);
            let weight = (solution.log_evidence - best.log_evidence).exp();
            if weight < LEAST_WEIGHT {
                continue;
            }
            whole += weight;
            let covariance = solution.eliminated.covariance();
            let steps = solution.steps.iter().zip(&best.steps);
            let off: Vec<f64> = steps.map(|(a, b)| a - b).collect();
            for (i, row) in sum.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += weight * (covariance[i][j] + off[i] * off[j]);
                }
            }
        }
        // Numbers that ran away have no evidence to weigh by.
        if whole > 0.0 {
            sum.iter_mut().flatten().for_each(|entry| *entry /= whole);
            self.solution.covariance = sum;
        }
        self
    }
}
