//! What the fits of a diagnosis cost and may cost, counted rather than timed: the same runs give
//! the same answer anywhere.

use std::sync::atomic::{AtomicU64, Ordering};

use super::survey::Survey;
use crate::model::{Acts, Term};

/// What all fits of a diagnosis have cost, in simulated values and changes of values.
#[derive(Debug, Default)]
pub(super) struct Spent(AtomicU64);

/// What a diagnosis may cost: some half a minute of the two cores of `docs/bench.md`.
pub(super) const MOST_SPENT: u64 = 5_000_000_000;
/// What one search for causes may cost of that.
const MOST_OF_ONE: u64 = 3_500_000_000;
/// Cost of an echo or of states that remember, against that of a value without; by a profile of
/// KVLCC2's decay with waves from the walls, roughly.
const COST_OF_ECHO: u64 = 2;
const COST_OF_LAG: u64 = 2;

impl Survey {
    /// A search for causes begins.
    pub(super) fn begin(&self) {
        let most = MOST_SPENT.min(self.n_spent() + MOST_OF_ONE);
        self.until.store(most, Ordering::Relaxed);
    }

    /// Whether the search for causes has cost what it may.
    pub(super) fn is_spent(&self) -> bool {
        self.n_spent() > self.until.load(Ordering::Relaxed)
    }

    /// What the diagnosis has cost so far.
    pub(super) fn n_spent(&self) -> u64 {
        self.spent.0.load(Ordering::Relaxed)
    }

    /// Counts a simulation of a run with so many changes.
    pub(super) fn spend(&self, run: usize, terms: &[Term], n_changes: usize) {
        let cost = |term: &Term| match term.effect.acts {
            Acts::Echo(_) => COST_OF_ECHO,
            Acts::Lagging(_) => COST_OF_LAG,
            _ => 1,
        };
        let observation = &self.runs[run];
        let n_values = observation.roll_time_s.len() + observation.moment_time_s.len();
        let each: u64 = 1 + terms.iter().map(cost).sum::<u64>();
        let of_run = n_values as u64 * (1 + n_changes as u64) * each;
        self.spent.0.fetch_add(of_run, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn a_search_ends_at_what_it_may_cost_and_the_next_at_what_is_left_of_the_whole() {
        let spent = Arc::new(Spent::default());
        let survey = Survey::new(Vec::new(), &spent);
        survey.begin();
        assert!(!survey.is_spent());
        spent.0.fetch_add(MOST_OF_ONE + 1, Ordering::Relaxed);
        assert!(survey.is_spent());
        let other = Survey::new(Vec::new(), &spent);
        other.begin();
        assert!(!other.is_spent(), "another search has its own share");
        spent.0.fetch_add(MOST_SPENT - MOST_OF_ONE, Ordering::Relaxed);
        assert!(other.is_spent(), "and both together have no more than the whole");
    }
}
