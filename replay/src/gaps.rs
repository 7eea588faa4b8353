//! Holes in a channel: intervals much longer than the channel's own.

use devices::{Quantity, Sample};

use crate::note::{Note, counted};

/// An interval is a hole when it is longer than this many typical ones; a single lost sample or a
/// hiccup of the recording computer is none.
const HOLE_INTERVALS: f64 = 5.0;
/// Intervals needed before the typical one is trusted.
const TRUSTED_INTERVALS: u64 = 20;
/// Factor by which the typical interval follows the intervals, at first and once it is trusted; the
/// first intervals may be far from typical, as when a program starts with a burst.
const STEPS: [f64; 2] = [1.5, 1.05];

/// Watches one channel's intervals and counts the holes.
#[derive(Debug, Clone)]
pub(crate) struct Gaps {
    quantity: Quantity,
    samples: u64,
    last_s: f64,
    typical_s: f64,
    holes: u64,
    total_s: f64,
    longest_s: f64,
    longest_from_s: f64,
}

impl Gaps {
    pub(crate) fn new(quantity: Quantity) -> Self {
        Self {
            quantity,
            samples: 0,
            last_s: 0.0,
            typical_s: 0.0,
            holes: 0,
            total_s: 0.0,
            longest_s: 0.0,
            longest_from_s: 0.0,
        }
    }

    /// Takes the channel's next sample.
    pub(crate) fn push(&mut self, sample: &Sample) {
        let interval_s = sample.time_s - self.last_s;
        if self.samples == 1 {
            self.typical_s = interval_s;
        } else if self.samples > 1 {
            if self.samples > TRUSTED_INTERVALS && interval_s > HOLE_INTERVALS * self.typical_s {
                self.hole(interval_s);
            }
            // Steps of equal size either way settle on the median, which holes cannot pull away.
            let step = STEPS[usize::from(self.samples > TRUSTED_INTERVALS)];
            self.typical_s *= if interval_s > self.typical_s { step } else { step.recip() };
        }
        self.samples += 1;
        self.last_s = sample.time_s;
    }

    fn hole(&mut self, interval_s: f64) {
        self.holes += 1;
        self.total_s += interval_s;
        if interval_s > self.longest_s {
            self.longest_s = interval_s;
            self.longest_from_s = self.last_s;
        }
    }

    /// Whether this is the quantity watched.
    pub(crate) fn is_of(&self, quantity: Quantity) -> bool {
        self.quantity == quantity
    }

    /// Appends what was found so far; `ended` when no sample can follow.
    pub(crate) fn notes(&self, ended: bool, notes: &mut Vec<Note>) {
        if ended && self.samples == 0 {
            notes.push(Note::lost(format!(
                "{}: the recording holds no sample",
                self.quantity.name()
            )));
        }
        if self.holes > 0 {
            notes.push(Note::lost(format!(
                "{}: {}, {:.3} s without samples in all, the longest {:.3} s after \
                 {:.3} s",
                self.quantity.name(),
                counted(self.holes, "gap"),
                self.total_s,
                self.longest_s,
                self.longest_from_s
            )));
        }
    }
}
