//! Gathers roll under the rod that does not become steady: a sweep, an irregular course.

use super::forced::{Cycle, drive_follows_decay};

/// Half cycles that tell inertia from damping whatever their course: twelve periods. What is
/// shorter is the way into a steady run or out of it.
const N_HALF_CYCLES_MIN: usize = 24;
/// Half cycles in a row in which an irregular force may be too small to be seen.
const N_FAINT: usize = 4;
/// Half cycles after which the rod is taken to be at work, so that no decay begins under it.
const N_AT_WORK: usize = 8;

/// Half cycles under the rod at a steady speed, none of which a run has used.
#[derive(Debug, Default)]
pub(super) struct Driven {
    cycles: Vec<Cycle>,
    n_faint: usize,
}

impl Driven {
    /// Time [s] from which samples are still needed.
    pub(super) fn needed_from_s(&self) -> Option<f64> {
        self.cycles.first().map(|c| c.half.start.time_s)
    }

    /// Whether the rod is at work, however faint its force is just now; a force that only follows
    /// a dying roll is none.
    pub(super) fn is_at_work(&self) -> bool {
        self.cycles.len() >= N_AT_WORK && !drive_follows_decay(&self.cycles)
    }

    /// Takes the next half cycle; whether the stretch goes on.
    pub(super) fn goes_on(&mut self, cycle: &Cycle) -> bool {
        if !cycle.steady {
            return false;
        }
        if cycle.is_driven() {
            self.n_faint = 0;
            self.cycles.push(*cycle);
            return true;
        }
        self.n_faint += 1;
        if !self.cycles.is_empty() && self.n_faint <= N_FAINT {
            self.cycles.push(*cycle);
            return true;
        }
        false
    }

    /// The half cycles up to `end_s`, if they are enough for a run; none are kept.
    pub(super) fn take(&mut self, end_s: f64) -> Option<Vec<Cycle>> {
        let mut cycles = std::mem::take(self).cycles;
        cycles.retain(|c| c.half.end.time_s <= end_s + 1e-9);
        while cycles.last().is_some_and(|c| !c.is_driven()) {
            cycles.pop();
        }
        (cycles.len() >= N_HALF_CYCLES_MIN).then_some(cycles)
    }
}
