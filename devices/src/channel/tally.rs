//! Counts of one channel over time, so that a run's own can be told when it has ended.

use std::collections::VecDeque;

use super::Counts;

/// Longest run, with what may pass until its end is known [s].
const KEPT_S: f64 = 2100.0;
/// Shortest time between two entries [s]; the counts of a run are exact to so much at its ends.
const STEP_S: f64 = 0.02;

/// What a channel's counts were, and when.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    entries: VecDeque<(f64, Counts)>,
}

impl Tally {
    /// The counts after the sample at `time_s`.
    pub fn note(&mut self, time_s: f64, counts: Counts) {
        match self.entries.back_mut() {
            Some((last_s, last)) if time_s - *last_s < STEP_S => *last = counts,
            _ => self.entries.push_back((time_s, counts)),
        }
        while self.entries.front().is_some_and(|(at_s, _)| *at_s < time_s - KEPT_S) {
            self.entries.pop_front();
        }
    }

    /// What was counted from `start_s` to `end_s`.
    pub fn between(&self, start_s: f64, end_s: f64) -> Counts {
        let until = |time_s: f64| {
            let n = self.entries.partition_point(|(at_s, _)| *at_s <= time_s);
            n.checked_sub(1).map(|last| self.entries[last].1).unwrap_or_default()
        };
        until(end_s) - until(start_s - STEP_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_runs_counts_are_those_between_its_ends() {
        let mut tally = Tally::default();
        let mut counts = Counts::default();
        for k in 0..1000_u64 {
            counts.received += 1;
            counts.lost += u64::from(k == 300) * 7;
            counts.damaged += u64::from(k == 700);
            tally.note(k as f64 * 0.1, counts);
        }
        let run = tally.between(25.0, 65.0);
        assert_eq!((run.received, run.lost, run.damaged), (401, 7, 0));
        let rest = tally.between(65.1, 1000.0);
        assert_eq!((rest.received, rest.lost, rest.damaged), (349, 0, 1));
    }
}
