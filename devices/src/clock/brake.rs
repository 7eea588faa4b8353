//! What holds a simulated clock back, so that nobody on a busy machine falls behind it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The brake of a clock; its clones are one brake.
#[derive(Debug, Clone)]
pub(super) struct Brake {
    state: Arc<Mutex<State>>,
}

#[expect(clippy::struct_field_names, reason = "the unit stands last in every name")]
#[derive(Debug)]
struct State {
    /// How far the clock may go [ns].
    limit_ns: u64,
    /// What it was held back in all [ns].
    held_ns: u64,
    last_ns: u64,
}

impl Brake {
    /// A brake that does not hold yet.
    pub(super) fn open() -> Self {
        let state = State { limit_ns: u64::MAX, held_ns: 0, last_ns: 0 };
        Self { state: Arc::new(Mutex::new(state)) }
    }

    /// Lets the clock go so far [ns] and no further.
    pub(super) fn at_most(&self, limit_ns: u64) {
        self.lock().limit_ns = limit_ns;
    }

    /// What a clock shows that would show `free_ns` without its brake.
    pub(super) fn held(&self, free_ns: u64) -> u64 {
        let mut state = self.lock();
        let now_ns = free_ns.saturating_sub(state.held_ns);
        let shown_ns = now_ns.min(state.limit_ns).max(state.last_ns);
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
        let brake = Brake::open();
        assert_eq!(brake.held(100), 100);
        brake.at_most(120);
        assert_eq!(brake.held(200), 120);
        brake.at_most(1000);
        assert_eq!(brake.held(220), 140);
        // It never goes back, not even for a brake that comes late.
        brake.at_most(10);
        assert_eq!(brake.held(500), 140);
        brake.at_most(u64::MAX);
        assert_eq!(brake.held(600), 240);
    }
}
