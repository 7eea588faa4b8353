//! Counters that wrap, skip, repeat or start over: sequence numbers and device ticks.

/// A counter of an instrument, continued beyond its width.
///
/// A sequence number says what was lost and what came twice. Device ticks (`micros()` wraps after
/// 71.58 minutes) need the host's elapsed time as well, for a pause may hide whole turns.
#[derive(Debug, Clone)]
pub struct Counter {
    bits: u32,
    last: Option<u64>,
}

/// How a counter moved since the value before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterStep {
    /// The first value since the start.
    First,
    /// The next value.
    Next,
    /// The same value again.
    Repeated,
    /// So many values are missing in between.
    Skipped(u64),
    /// The counter went back: the instrument started anew.
    Restarted,
}

impl Counter {
    /// A counter of so many bits.
    ///
    /// # Panics
    /// When `bits` is not in 1..=64.
    pub fn new(bits: u32) -> Self {
        assert!((1..=64).contains(&bits), "a counter of {bits} bits");
        Self { bits, last: None }
    }

    fn turn(&self) -> u128 {
        1 << self.bits
    }

    /// The continued value of a sequence number and its step from the one before.
    pub fn sequence(&mut self, value: u64) -> (u64, CounterStep) {
        let value = value & u64::try_from(self.turn() - 1).unwrap_or(u64::MAX);
        let Some(last) = self.last else {
            self.last = Some(value);
            return (value, CounterStep::First);
        };
        let turn = self.turn();
        let ahead = (u128::from(value) + turn - u128::from(last) % turn) % turn;
        // More than half a turn ahead is a step back: a restart, not a loss.
        if ahead > turn / 2 {
            self.last = Some(value);
            return (value, CounterStep::Restarted);
        }
        let ahead = u64::try_from(ahead).unwrap_or(u64::MAX);
        let continued = last.saturating_add(ahead);
        self.last = Some(continued);
        let step = match ahead {
            0 => CounterStep::Repeated,
            1 => CounterStep::Next,
            _ => CounterStep::Skipped(ahead - 1),
        };
        (continued, step)
    }

    /// The continued value of ticks that should have advanced by `elapsed_ticks`, give or take
    /// `tolerance_ticks`; none when no number of turns explains them, so that the device restarted.
    pub fn ticks(&mut self, value: u64, elapsed_ticks: f64, tolerance_ticks: f64) -> Option<u64> {
        let Some(last) = self.last else {
            self.last = Some(value);
            return Some(value);
        };
        let turn = self.turn() as f64;
        let step = value as f64 - (u128::from(last) % self.turn()) as f64;
        let turns = ((elapsed_ticks - step) / turn).round().max(0.0);
        let advance = step + turns * turn;
        let known = advance >= 0.0 && (advance - elapsed_ticks).abs() <= tolerance_ticks;
        let continued = if known { last.saturating_add(advance as u64) } else { value };
        self.last = Some(continued);
        known.then_some(continued)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrapping_sequence_counts_what_is_missing() {
        use CounterStep::{First, Next, Repeated, Skipped};
        let mut counter = Counter::new(8);
        let steps: Vec<_> = [253, 254, 254, 1, 2].map(|value| counter.sequence(value)).into();
        let expected = [(253, First), (254, Next), (254, Repeated), (257, Skipped(2)), (258, Next)];
        assert_eq!(steps, expected);
        assert_eq!(counter.sequence(0).1, CounterStep::Restarted);
    }

    #[test]
    fn micros_wrap_and_a_long_pause_hides_no_turn() {
        let mut counter = Counter::new(32);
        let turn = 2f64.powi(32);
        assert_eq!(counter.ticks(4_294_000_000, 0.0, 1e6), Some(4_294_000_000));
        let wrapped = counter.ticks(1_000_000, 1_967_296.0, 1e6).unwrap();
        assert_eq!(wrapped, 4_294_967_296 + 1_000_000);
        // Two whole turns pass while the cable is out.
        let later = counter.ticks(1_500_000, 2.0 * turn + 500_000.0 + 3e5, 1e6).unwrap();
        assert_eq!(later, wrapped + 2 * 4_294_967_296 + 500_000);
    }

    #[test]
    fn a_reboot_is_not_taken_for_a_turn() {
        let mut counter = Counter::new(32);
        counter.ticks(100_000_000, 0.0, 1e6);
        assert_eq!(counter.ticks(1_000, 2e6, 1e6), None);
        assert_eq!(counter.ticks(11_000, 1e4, 1e6), Some(11_000));
    }
}
