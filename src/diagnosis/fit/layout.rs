//! The numbers of a campaign as columns, and which of them move each run.

use super::elimination::Place;
use super::survey::{Fit, N_LAW, Survey};
use crate::model::N_BASE;

/// The columns that belong to the campaign: laws, scale, parameters of the extensions.
pub(in crate::diagnosis) struct Layout {
    n_conditions: usize,
    /// First column of every extension.
    firsts: Vec<usize>,
    /// Number of columns.
    pub(in crate::diagnosis) n: usize,
}

impl Layout {
    pub(in crate::diagnosis) fn new(survey: &Survey, fit: &Fit) -> Self {
        let n_conditions = survey.conditions.len();
        let mut n = N_LAW * n_conditions + 1;
        let mut firsts = Vec::new();
        for extension in &fit.extensions {
            firsts.push(n);
            n += extension.slots.len() * extension.effect.n_parameters();
        }
        Self { n_conditions, firsts, n }
    }

    pub(super) fn scale(&self) -> usize {
        N_LAW * self.n_conditions
    }

    /// Column of a parameter of a set of an extension.
    pub(in crate::diagnosis) fn parameter(
        &self,
        fit: &Fit,
        extension: usize,
        slot: usize,
        k: usize,
    ) -> usize {
        self.firsts[extension] + slot * fit.extensions[extension].effect.n_parameters() + k
    }

    /// For every column of a run's base and terms, and for its record, those of the campaign.
    pub(super) fn places(&self, survey: &Survey, fit: &Fit, run: usize) -> Vec<Place> {
        let law = N_LAW * survey.condition_of[run];
        let square = survey.runs[run].at.froude.powi(2);
        let mut places = vec![
            Place::new(0, law),
            Place::new(1, law + 1),
            Place { theirs: 1, ours: law + 2, by: square },
            Place::new(2, law + 3),
            Place::new(3, self.scale()),
        ];
        let mut theirs = N_BASE;
        for (e, extension) in fit.extensions.iter().enumerate() {
            if let Some(slot) = extension.slot_of[run] {
                for k in 0..extension.effect.n_parameters() {
                    places.push(Place::new(theirs, self.parameter(fit, e, slot, k)));
                    theirs += 1;
                }
            }
        }
        places.push(Place::new(theirs, self.n));
        places
    }

    /// What steps of the campaign's numbers are to a run's base and terms.
    pub(super) fn local(places: &[Place], steps: &[f64]) -> Vec<f64> {
        let record = places[places.len() - 1].theirs;
        let mut local = vec![0.0; record];
        for place in places.iter().filter(|place| place.theirs < record) {
            local[place.theirs] += place.by * steps[place.ours];
        }
        local
    }
}
