//! What holds a simulated clock back, so that nobody on a busy machine is late by it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The brakes of one clock.
#[derive(Debug, Clone, Default)]
pub(super) struct Brakes {
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    /// How far each lets the clock go [ns].
    limits_ns: Vec<u64>,
    /// What the clock was held back in all [ns].
    held_ns: u64,
    last_ns: u64,
}

/// One hand on a clock; the clock is free of it when it is dropped.
#[derive(Debug)]
pub struct Brake {
    brakes: Brakes,
    index: usize,
}

impl Brake {
    /// Lets the clock go so far [ns] and no further; a clock beyond that stands still.
    pub fn at_most(&self, limit_ns: u64) {
        self.brakes.lock().limits_ns[self.index] = limit_ns;
    }
}

impl Drop for Brake {
    fn drop(&mut self) {
        self.at_most(u64::MAX);
    }
}

impl Brakes {
    /// A further hand, which does not hold the clock yet.
    pub(super) fn brake(&self) -> Brake {
        let mut state = self.lock();
        state.limits_ns.push(u64::MAX);
        Brake { brakes: self.clone(), index: state.limits_ns.len() - 1 }
    }

    /// What a clock shows that would show `free_ns` without brakes.
    pub(super) fn held(&self, free_ns: u64) -> u64 {
        let mut state = self.lock();
        let limit_ns = state.limits_ns.iter().copied().min().unwrap_or(u64::MAX);
        let now_ns = free_ns.saturating_sub(state.held_ns);
        let shown_ns = now_ns.min(limit_ns).max(state.last_ns);
        state.held_ns += now_ns.saturating_sub(shown_ns);
        state.last_ns = shown_ns;
        shown_ns
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // Nothing panics while it is held.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_stands_at_its_brake_and_goes_on_from_there() {
        let brakes = Brakes::default();
        let (first, second) = (brakes.brake(), brakes.brake());
        assert_eq!(brakes.held(100), 100);
        first.at_most(150);
        second.at_most(120);
        assert_eq!(brakes.held(200), 120);
        second.at_most(1000);
        assert_eq!(brakes.held(220), 140);
        assert_eq!(brakes.held(400), 150);
        // It never goes back, not even for a brake that comes late.
        first.at_most(10);
        assert_eq!(brakes.held(500), 150);
        drop((first, second));
        assert_eq!(brakes.held(600), 250);
    }
}
