//! Which disturbances a record speaks for: every noise, and misfits of every size and order.

use super::disturbance::{Columns, Disturbance, Misfit, Noise};
use super::form::FORMS;
use super::solution::Plan;
use crate::inverse::state_space::filter::Filtered;

/// Prior probability that the law leaves a moment, and that the noise remembers: a record that
/// shows either outweighs this by many orders, and a record that shows neither is not clouded.
const UNLAWFUL: f64 = 0.05;

/// Correlation of neighbouring samples of a coloured noise [-], each as likely beforehand.
const CORRELATIONS: [f64; 3] = [0.3, 0.6, 0.85];

/// Logarithms of the smallest and the largest misfit, in units of the roll noise, between which
/// all are as likely: the smallest begins to show, the largest leaves the law nothing to say.
const MISFITS: (f64, f64) = (-1.5, 6.0);
/// Step of the first look at them.
const COARSE: f64 = 1.25;
/// The first look ends where the evidence has fallen by this much from its best.
const FALLEN: f64 = 7.0;
/// Evidence that a misfit must gain over none before its size and order are looked at closely.
const PROMISING: f64 = 3.0;

/// A disturbance that stands for its neighbours too.
pub(super) struct Candidate<'a> {
    pub(super) disturbance: Disturbance,
    pub(super) filtered: Filtered,
    pub(super) plans: &'a [Plan],
    /// Logarithm of prior times evidence of each plan.
    pub(super) log_parts: Vec<f64>,
    /// Logarithm of their sum.
    pub(super) log_evidence: f64,
    /// The same without the disturbance's own prior.
    log_likelihood: f64,
}

/// The disturbances of one record.
pub(super) struct Search<'a> {
    columns: &'a Columns,
    plans: Vec<Plan>,
}

impl<'a> Search<'a> {
    pub(super) fn new(columns: &'a Columns, noise_rad: f64, floor_rad2: f64) -> Self {
        let plans = (0..FORMS.len())
            .flat_map(|form| [false, true].map(|k3| Plan::new(form, k3, noise_rad, floor_rad2)))
            .collect();
        Self { columns, plans }
    }

    /// Every disturbance worth weighing.
    pub(super) fn candidates(&self) -> Vec<Candidate<'_>> {
        let (lawful, unlawful) = ((1.0 - UNLAWFUL).ln(), UNLAWFUL.ln());
        let coloured = unlawful - (CORRELATIONS.len() as f64).ln();
        let spacing = self.columns.spacing();
        // A memory `a` gains n (a r - a^2/2) over none where neighbours correlate by r.
        let least = 0.5 * CORRELATIONS[0];
        let remembers = self.columns.neighbours_correlate() > least;
        let memories = CORRELATIONS
            .into_iter()
            .filter(|_| remembers)
            .map(|a| (Noise::Coloured(-spacing / a.ln()), coloured));
        let noises: Vec<(Noise, f64)> =
            std::iter::once((Noise::White, lawful)).chain(memories).collect();
        let mut all: Vec<Candidate<'_>> = noises
            .iter()
            .map(|&(noise, prior)| self.candidate(noise, None, prior + lawful))
            .collect();
        let best_noise = best(&all).disturbance.noise;
        // A misfit is looked for under white noise, and under a memory where there seems to be one.
        for (i, &(noise, prior)) in noises.iter().enumerate() {
            if noise != Noise::White && noise != best_noise {
                continue;
            }
            let none = all[i].log_likelihood;
            let log_prior = prior + unlawful - (MISFITS.1 - MISFITS.0).ln();
            let coarse = self.coarse(noise, 2, log_prior);
            if best(&coarse).log_likelihood < none + PROMISING {
                // Nothing to be smooth or rough: one order stands for all.
                all.extend(coarse);
                continue;
            }
            let third = log_prior - 3.0_f64.ln();
            for order in [1, 2, 3] {
                let coarse = self.coarse(noise, order, third);
                all.extend(self.quadrature(noise, order, third, coarse));
            }
        }
        all
    }

    /// A first look at the sizes of a misfit.
    fn coarse(&self, noise: Noise, order: usize, log_prior: f64) -> Vec<Candidate<'_>> {
        let n_steps = ((MISFITS.1 - MISFITS.0) / COARSE) as u32;
        let mut found: Vec<Candidate<'_>> = Vec::new();
        let mut top = f64::NEG_INFINITY;
        for i in 0..=n_steps {
            let sd = (MISFITS.0 + COARSE * f64::from(i)).exp();
            let next = self.candidate(noise, Some(Misfit { order, sd }), log_prior + COARSE.ln());
            top = top.max(next.log_evidence);
            let fallen = next.log_evidence < top - FALLEN;
            found.push(next);
            if fallen {
                break;
            }
        }
        found
    }

    /// Nodes about the best of the coarse sizes, where one stands out; the coarse ones elsewhere.
    fn quadrature<'b>(
        &'b self,
        noise: Noise,
        order: usize,
        log_prior: f64,
        coarse: Vec<Candidate<'b>>,
    ) -> Vec<Candidate<'b>> {
        let at = |x: f64, width: f64| {
            let misfit = Misfit { order, sd: x.exp() };
            self.candidate(noise, Some(misfit), log_prior + width.ln())
        };
        let evidence = |x: f64| at(x, 1.0).log_evidence;
        let mut mode = best(&coarse).disturbance.misfit.map_or(0.0, |m| m.sd.ln());
        if mode <= MISFITS.0 || mode >= MISFITS.1 - COARSE {
            return coarse;
        }
        let mut width = COARSE;
        for _ in 0..2 {
            // Newton's step on the parabola through three points.
            let reach = 0.5 * width;
            let points = [mode - reach, mode, mode + reach].map(evidence);
            let slope = (points[2] - points[0]) / (2.0 * reach);
            let bend = (points[2] - 2.0 * points[1] + points[0]) / (reach * reach);
            if bend >= -0.1 {
                // As flat as the prior: the coarse look is a quadrature already.
                return coarse;
            }
            mode += (-slope / bend).clamp(-COARSE, COARSE);
            width = (-bend).sqrt().recip().min(COARSE);
        }
        // A trapezium rule of one standard deviation's step over a bell curve errs by 1e-8.
        (-3..=3).map(|i| at(mode + width * f64::from(i), width)).collect()
    }

    fn candidate(&self, noise: Noise, misfit: Option<Misfit>, log_prior: f64) -> Candidate<'_> {
        let disturbance = Disturbance { noise, misfit };
        let filtered = self.columns.whiten(&disturbance);
        // Each form comes with one of two restorings.
        let part = |plan: &Plan| {
            log_prior + (0.5 * FORMS[plan.form].share).ln() + plan.log_evidence(&filtered)
        };
        let log_parts: Vec<f64> = self.plans.iter().map(part).collect();
        let log_evidence = log_sum(log_parts.iter().copied());
        Candidate {
            disturbance,
            filtered,
            plans: &self.plans,
            log_parts,
            log_evidence,
            log_likelihood: log_evidence - log_prior,
        }
    }
}

fn best<'a, 'b>(candidates: &'a [Candidate<'b>]) -> &'a Candidate<'b> {
    candidates
        .iter()
        .reduce(|a, b| if b.log_evidence > a.log_evidence { b } else { a })
        .expect("there is a candidate")
}

/// Logarithm of the sum of exponentials.
pub(super) fn log_sum(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let top = values.clone().fold(f64::NEG_INFINITY, f64::max);
    top + values.map(|v| (v - top).exp()).sum::<f64>().ln()
}
