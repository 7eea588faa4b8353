//! A model with all that the runs so far say of it, and how probable more runs would make it.

use crate::diagnosis::fit::added::Added;
use crate::diagnosis::fit::elimination::Products;
use crate::diagnosis::fit::run_fit::Summary;
use crate::diagnosis::fit::scatter::{Scatter, all_scatters, scatters};
use crate::diagnosis::fit::settle::Settled;
use crate::diagnosis::fit::solve::{Joint, log_mean_exp};
use crate::diagnosis::fit::survey::{Fit, Survey};

/// A settled model with the runs so far under every scatter: what a model does not follow it may
/// take for scatter.
pub(super) struct Known {
    pub(super) settled: Settled,
    /// The runs so far under the likeliest scatter.
    pub(super) products: Products,
    under: Vec<Under>,
    /// Logarithm of the evidence of the runs so far, up to what more runs do not change.
    log_evidence: f64,
}

/// The runs so far under one scatter.
struct Under {
    scatter: Scatter,
    products: Products,
    log_occam: f64,
}

impl Known {
    pub(super) fn new(survey: &Survey, settled: Settled) -> Self {
        let joint = Joint::new(survey, &settled.fit, &settled.summaries);
        let of = |scatter| {
            let (marginals, products) = joint.gathered(&scatter);
            let log_occam = marginals.iter().map(|marginal| marginal.log_occam).sum();
            Under { scatter, products, log_occam }
        };
        let log = |under: Under| {
            let eliminated = under.products.eliminate(joint.layout.n);
            under.log_occam - 0.5 * (eliminated.rest.at(0, 0) + eliminated.log_determinant)
        };
        let logs: Vec<f64> = scatters(survey).into_iter().map(of).map(log).collect();
        let products = joint.gathered(&settled.solution.scatter).1;
        let under = all_scatters().map(of).collect();
        Self { products, under, log_evidence: log_mean_exp(&logs), settled }
    }

    /// Logarithm by which runs added to a survey, as `fit` stands in them, change the evidence.
    pub(super) fn gains(&self, grown: &Survey, fit: &Fit, added: &[Summary]) -> f64 {
        let of_states: f64 = added.iter().map(|summary| summary.log_occam).sum();
        let log = |Under { scatter, products, log_occam }: &Under| {
            let added = Added::new((&self.settled.fit, products), grown, fit, added, scatter);
            log_occam + added.log_evidence()
        };
        let logs: Vec<f64> = self.under.iter().map(log).collect();
        of_states + log_mean_exp(&logs) - self.log_evidence
    }
}
