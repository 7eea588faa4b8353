//! What the fits of a diagnosis cost and may cost, counted rather than timed: the same runs give
//! the same answer anywhere.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::model::{Acts, Term};

/// What all fits of a diagnosis have cost, in simulated values and changes of values.
#[derive(Debug, Default)]
pub(in crate::diagnosis) struct Spent(AtomicU64);

/// What a diagnosis may cost: some half a minute of the two cores of `docs/bench.md`.
const MOST_SPENT: u64 = 5_000_000_000;
/// What one search for causes may cost of that.
const MOST_OF_ONE: u64 = 3_500_000_000;
/// Cost of an echo or of states that remember, against that of a value without; by a profile of
/// KVLCC2's decay with waves from the walls, roughly.
const COST_OF_ECHO: u64 = 2;
const COST_OF_LAG: u64 = 2;

/// What a diagnosis has cost so far, and what it may have cost when one search ends.
pub(in crate::diagnosis) struct Cost {
    spent: Arc<Spent>,
    until: AtomicU64,
}

impl Cost {
    /// Of a diagnosis that has cost so much.
    pub(super) fn new(spent: &Arc<Spent>) -> Self {
        Self { spent: Arc::clone(spent), until: AtomicU64::new(MOST_SPENT) }
    }

    /// The same, counted with it and without a limit.
    pub(in crate::diagnosis) fn unlimited(&self) -> Self {
        Self { spent: Arc::clone(&self.spent), until: AtomicU64::new(u64::MAX) }
    }

    /// A search for causes begins, or what comes after the last.
    pub(in crate::diagnosis) fn begin(&self) {
        let most = MOST_SPENT.min(self.n_spent() + MOST_OF_ONE);
        self.until.store(most, Ordering::Relaxed);
    }

    /// Whether the search for causes has cost what it may.
    pub(in crate::diagnosis) fn is_spent(&self) -> bool {
        self.n_spent() > self.until.load(Ordering::Relaxed)
    }

    /// What the diagnosis has cost so far.
    pub(in crate::diagnosis) fn n_spent(&self) -> u64 {
        self.spent.0.load(Ordering::Relaxed)
    }

    /// Counts a simulation of so many values with so many changes.
    pub(super) fn spend(&self, n_values: usize, terms: &[Term], n_changes: usize) {
        let cost = |term: &Term| match term.effect.acts {
            Acts::Echo(_) => COST_OF_ECHO,
            Acts::Lagging(_) => COST_OF_LAG,
            _ => 1,
        };
        let each: u64 = 1 + terms.iter().map(cost).sum::<u64>();
        let of_run = n_values as u64 * (1 + n_changes as u64) * each;
        self.spent.0.fetch_add(of_run, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_ends_at_what_it_may_cost_and_the_next_at_what_is_left_of_the_whole() {
        let spent = Arc::new(Spent::default());
        let cost = Cost::new(&spent);
        cost.begin();
        assert!(!cost.is_spent());
        spent.0.fetch_add(MOST_OF_ONE + 1, Ordering::Relaxed);
        assert!(cost.is_spent());
        let other = Cost::new(&spent);
        other.begin();
        assert!(!other.is_spent(), "another search has its own share");
        spent.0.fetch_add(MOST_SPENT - MOST_OF_ONE, Ordering::Relaxed);
        assert!(other.is_spent(), "and both together have no more than the whole");
    }
}
