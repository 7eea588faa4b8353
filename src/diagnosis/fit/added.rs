//! A campaign solved with runs added to it, whose readings alone are new.

use super::elimination::{Eliminated, Place, Products};
use super::layout::Layout;
use super::run_fit::{RunState, Summary};
use super::scatter::Scatter;
use super::solve::{Marginal, add_prior, deviating, marginal, moved_extensions, moved_state};
use super::survey::{Extension, Fit, Survey};

/// The last runs of a survey added to what the others gave.
pub(in crate::diagnosis) struct Added {
    /// The campaign's numbers eliminated.
    pub(in crate::diagnosis) eliminated: Eliminated,
    layout: Layout,
    marginals: Vec<Marginal>,
    steps: Vec<f64>,
    /// Logarithm of the precision of the priors of sets that the added runs have of their own.
    log_prior: f64,
}

impl Added {
    /// Adds the runs of the summaries, the last of the survey, to the others under `known`, a fit
    /// without the sets of parameters that the added runs have of their own.
    pub(in crate::diagnosis) fn new(
        (known, others): (&Fit, &Products),
        survey: &Survey,
        fit: &Fit,
        summaries: &[Summary],
        scatter: &Scatter,
    ) -> Self {
        let layout = Layout::new(survey, fit);
        let (mut all, log_prior) = widened(others, survey, known, fit);
        let first = survey.runs.len() - summaries.len();
        let marginals: Vec<Marginal> = summaries
            .iter()
            .zip(first..)
            .map(|(summary, run)| {
                let own = deviating(survey, fit, run, summary);
                let marginal = marginal(survey, fit, run, own, scatter);
                all.gather(&marginal.eliminated.rest, &layout.places(survey, fit, run));
                marginal
            })
            .collect();
        let eliminated = all.eliminate(layout.n);
        let steps = eliminated.back(&[]);
        Self { eliminated, layout, marginals, steps, log_prior }
    }

    /// Least misfit that the linearised model reaches.
    pub(in crate::diagnosis) fn least_misfit(&self) -> f64 {
        self.eliminated.rest.at(0, 0)
    }

    /// Logarithm of the evidence, but for the Occam factors of the other runs, of the added runs'
    /// states and of the numbers that all have in common.
    pub(in crate::diagnosis) fn log_evidence(&self) -> f64 {
        let of_scatter: f64 = self.marginals.iter().map(|marginal| marginal.log_occam).sum();
        of_scatter + 0.5 * self.log_prior
            - 0.5 * (self.least_misfit() + self.eliminated.log_determinant)
    }

    /// The effects, and the states of the added runs, after the step.
    pub(in crate::diagnosis) fn moved(
        &self,
        survey: &Survey,
        fit: &Fit,
        summaries: &[Summary],
    ) -> (Vec<Extension>, Vec<RunState>) {
        let first = survey.runs.len() - summaries.len();
        let log_scale = fit.log_scale + self.steps[self.layout.scale()];
        let states = summaries.iter().zip(&self.marginals).zip(first..);
        let states = states.map(|((summary, marginal), run)| {
            let local = Layout::local(&self.layout.places(survey, fit, run), &self.steps);
            let mut state = moved_state(survey, fit, run, summary, marginal, &local, 1.0);
            state.base.log_scale = log_scale;
            state
        });
        (moved_extensions(fit, &self.layout, &self.steps), states.collect())
    }
}

/// Products under a fit as those of one with more sets of parameters, of which only the priors
/// are known, with the logarithm of the precision of these.
fn widened(others: &Products, survey: &Survey, known: &Fit, fit: &Fit) -> (Products, f64) {
    let (before, after) = (Layout::new(survey, known), Layout::new(survey, fit));
    let mut places: Vec<Place> = (0..=before.scale()).map(|i| Place::new(i, i)).collect();
    let mut priors = Vec::new();
    for (e, extension) in fit.extensions.iter().enumerate() {
        for (s, values) in extension.slots.iter().enumerate() {
            for (k, value) in values.iter().enumerate() {
                let column = after.parameter(fit, e, s, k);
                if s < known.extensions[e].slots.len() {
                    places.push(Place::new(before.parameter(known, e, s, k), column));
                } else {
                    priors.push((column, value - extension.centres[s][k], e, k));
                }
            }
        }
    }
    places.push(Place::new(before.n, after.n));
    let mut all = Products::zero(after.n + 1);
    all.gather(others, &places);
    let mut log_prior = 0.0;
    for (column, off_centre, e, k) in priors {
        let sd = fit.extensions[e].effect.parameter(k).typical;
        if sd > 0.0 {
            add_prior(&mut all, column, off_centre, sd);
            log_prior -= 2.0 * sd.ln();
        }
    }
    (all, log_prior)
}
