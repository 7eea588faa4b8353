//! What one channel has brought over time, so that a run's own can be told when it has ended.

use std::collections::VecDeque;

use super::{Brought, Counted, Counts};
use crate::Quantity;

/// Longest run, with what may pass until its end is known [s].
const KEPT_S: f64 = 2100.0;
/// Shortest time between two entries [s]; the counts of a run are exact to so much at its ends.
const STEP_S: f64 = 0.02;

/// What a channel's counts were, and when.
#[derive(Debug, Clone)]
pub struct Tally {
    quantity: Quantity,
    entries: VecDeque<Entry>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    time_s: f64,
    /// Largest bound of the samples since the entry before [s], where all have one.
    bound_s: Option<f64>,
    counts: Counts,
}

impl Tally {
    /// Of a channel that has brought nothing yet.
    pub fn new(quantity: Quantity) -> Self {
        Self { quantity, entries: VecDeque::new() }
    }

    /// Takes the channel's counts as they stand at its newest sample.
    pub fn note(&mut self, counted: &Counted) {
        let Counted { time_s, bound_s, counts, .. } = *counted;
        match self.entries.back_mut() {
            Some(last) if time_s - last.time_s < STEP_S => {
                last.bound_s = larger(last.bound_s, bound_s);
                last.counts = counts;
            }
            _ => self.entries.push_back(Entry { time_s, bound_s, counts }),
        }
        while self.entries.front().is_some_and(|entry| entry.time_s < time_s - KEPT_S) {
            self.entries.pop_front();
        }
    }

    /// Forgets what no stretch that begins later needs.
    pub fn forget_before(&mut self, time_s: f64) {
        // The state before such a stretch is that of the last entry before it.
        while self.entries.get(1).is_some_and(|second| second.time_s < time_s - STEP_S) {
            self.entries.pop_front();
        }
    }

    /// What the channel brought from `start_s` to `end_s`.
    pub fn between(&self, start_s: f64, end_s: f64) -> Brought {
        let until =
            |n: usize| n.checked_sub(1).map(|last| self.entries[last].counts).unwrap_or_default();
        let [from, to] = self.range(start_s, end_s);
        let bounds_s = self.entries.range(from..to).map(|entry| entry.bound_s);
        let bound_s = bounds_s.reduce(larger).flatten();
        Brought { quantity: self.quantity, counts: until(to) - until(from), bound_s }
    }

    /// Whether each sample then came in one frame with one of the other channel, so that one stamp
    /// holds for both.
    pub fn is_stamped_with(&self, other: &Self, start_s: f64, end_s: f64) -> bool {
        // No two frames are stamped alike to the bit.
        let stamps = |tally: &Self| -> Vec<u64> {
            let [from, to] = tally.range(start_s, end_s);
            tally.entries.range(from..to).map(|entry| entry.time_s.to_bits()).collect()
        };
        let own = stamps(self);
        !own.is_empty() && own == stamps(other)
    }

    /// Entries after `start_s` up to `end_s`.
    fn range(&self, start_s: f64, end_s: f64) -> [usize; 2] {
        [start_s - STEP_S, end_s]
            .map(|until_s| self.entries.partition_point(|entry| entry.time_s <= until_s))
    }
}

/// The larger of two bounds, where both are known.
fn larger(one_s: Option<f64>, other_s: Option<f64>) -> Option<f64> {
    Some(one_s?.max(other_s?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(time_s: f64, bound_s: f64, counts: Counts) -> Counted {
        Counted { quantity: Quantity::Roll, time_s, bound_s: Some(bound_s), counts }
    }

    #[test]
    fn a_runs_counts_and_bound_are_those_between_its_ends() {
        let mut tally = Tally::new(Quantity::Roll);
        let mut counts = Counts::default();
        for k in 0..1000_u64 {
            counts.received += 1;
            counts.lost += u64::from(k == 300) * 7;
            counts.damaged += u64::from(k == 700);
            let bound_s = if k == 400 { 2e-3 } else { 1e-3 };
            tally.note(&counted(k as f64 * 0.1, bound_s, counts));
        }
        let run = tally.between(25.0, 65.0);
        assert_eq!((run.counts.received, run.counts.lost, run.counts.damaged), (401, 7, 0));
        assert!((run.bound_s.unwrap() - 2e-3).abs() < 1e-12, "{run:?}");
        tally.forget_before(65.1);
        let rest = tally.between(65.1, 1000.0);
        assert_eq!((rest.counts.received, rest.counts.lost, rest.counts.damaged), (349, 0, 1));
        assert!((rest.bound_s.unwrap() - 1e-3).abs() < 1e-12, "{rest:?}");
        // One sample of which nobody knows how late it is leaves none of the run.
        tally.note(&Counted { bound_s: None, ..counted(100.0, 0.0, counts) });
        assert_eq!(tally.between(65.1, 1000.0).bound_s, None);
    }

    #[test]
    fn channels_of_one_frame_are_stamped_together_and_others_are_not() {
        let note = |later_s: f64| {
            let mut tally = Tally::new(Quantity::Roll);
            for k in 0..100 {
                let time_s = f64::from(k) * 0.1 + later_s;
                tally.note(&counted(time_s, 1e-3, Counts::default()));
            }
            tally
        };
        assert!(note(0.0).is_stamped_with(&note(0.0), 2.0, 8.0));
        assert!(!note(0.0).is_stamped_with(&note(1e-6), 2.0, 8.0));
        assert!(!note(0.0).is_stamped_with(&note(0.0), 20.0, 80.0));
    }
}
