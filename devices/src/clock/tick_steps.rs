//! Samples missing from a stream that stamps its samples and does not count them.

use std::collections::VecDeque;

use super::CounterStep;

/// Steps of which the middle one is the period.
const STEPS: usize = 15;
/// Steps before which nothing is said.
const STEPS_MIN: usize = 8;
/// A longer step has room for another sample.
const LONG_PERIODS: f64 = 1.5;
/// A steady instrument keeps its steps to this part of a period, but for the losses.
const STEADY_PERIODS: f64 = 0.25;
/// So large a part of the steps must be steady.
const STEADY_PART: f64 = 0.6;

/// Learns an instrument's period in its own ticks; a link cannot make these late.
#[derive(Debug, Clone, Default)]
pub(crate) struct TickSteps {
    last: Option<u64>,
    steps: VecDeque<u64>,
}

impl TickSteps {
    /// What the step to these continued ticks says.
    pub(crate) fn next(&mut self, ticks: u64) -> CounterStep {
        let Some(last) = self.last.replace(ticks) else { return CounterStep::First };
        let step = ticks.saturating_sub(last);
        let period = self.period();
        // A clock of milliseconds may stand still between two samples of a fast board.
        if step == 0 {
            return match period {
                Some(period) if period >= 2 => CounterStep::Repeated,
                _ => CounterStep::Next,
            };
        }
        if self.steps.len() == STEPS {
            self.steps.pop_front();
        }
        self.steps.push_back(step);
        match period.map(|period| step as f64 / period as f64) {
            Some(periods) if periods > LONG_PERIODS => {
                CounterStep::Skipped(periods.round() as u64 - 1)
            }
            _ => CounterStep::Next,
        }
    }

    /// The middle step, where most are like it.
    fn period(&self) -> Option<u64> {
        if self.steps.len() < STEPS_MIN {
            return None;
        }
        let mut sorted: Vec<u64> = self.steps.iter().copied().collect();
        sorted.sort_unstable();
        let middle = sorted[sorted.len() / 2];
        let steady = STEADY_PERIODS * middle as f64;
        let n_steady =
            sorted.iter().filter(|step| step.abs_diff(middle) as f64 <= steady.max(1.0)).count();
        (n_steady as f64 >= STEADY_PART * sorted.len() as f64).then_some(middle)
    }
}

#[cfg(test)]
mod tests {
    use super::CounterStep::{First, Next, Repeated, Skipped};
    use super::*;

    #[test]
    fn a_long_step_is_so_many_samples_and_none_is_the_same_one() {
        let mut steps = TickSteps::default();
        assert_eq!(steps.next(5000), First);
        for index in 1..100 {
            // A loop in a sketch is a little late now and then.
            assert_eq!(steps.next(5000 + index * 10_000 + index % 3 * 400), Next, "{index}");
        }
        assert_eq!(steps.next(1_035_000), Skipped(3));
        assert_eq!(steps.next(1_035_000), Repeated);
        assert_eq!(steps.next(1_045_000), Next);
        assert_eq!(steps.next(1_065_000), Skipped(1));
    }

    #[test]
    fn an_instrument_without_a_period_and_a_coarse_clock_are_not_said_to_lose_anything() {
        let mut steps = TickSteps::default();
        for index in 0_u64..500 {
            let ticks = 7000 * index + index * index % 6007;
            assert!(matches!(steps.next(ticks), First | Next), "{index}");
        }
        // 2 kHz in milliseconds.
        let mut steps = TickSteps::default();
        for index in 0..500 {
            assert!(matches!(steps.next(index / 2), First | Next), "{index}");
        }
    }

    #[test]
    fn another_rate_is_learnt() {
        let mut steps = TickSteps::default();
        for index in 0..50 {
            steps.next(index * 1000);
        }
        let more: Vec<_> = (0..50).map(|index| steps.next(50_000 + index * 4000)).collect();
        assert!(more[20..].iter().all(|step| *step == Next), "{more:?}");
    }
}
