//! What was received, lost, repeated, over range and damaged, per channel or link, and how well
//! its times are known.

use std::ops::{AddAssign, Sub};

use serde::{Deserialize, Serialize};

use crate::Quantity;

/// Counts of one channel; nothing that went wrong is left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Samples that were delivered.
    pub received: u64,
    /// Samples that are missing by the sequence number, by silence or by cycles not begun.
    pub lost: u64,
    /// Conversions that came again and were not delivered.
    pub repeated: u64,
    /// Delivered samples beyond the range of instrument or channel.
    pub over_range: u64,
    /// Frames that were no frame, or failed their check.
    pub damaged: u64,
}

impl Counts {
    /// Whether nothing went wrong.
    pub fn is_whole(&self) -> bool {
        [self.lost, self.repeated, self.over_range, self.damaged].iter().all(|count| *count == 0)
    }
}

/// The counts of a channel as they stood at its newest sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counted {
    /// What the channel measures.
    pub quantity: Quantity,
    /// Time of its newest sample [s].
    pub time_s: f64,
    /// The time of that sample is at most so far off [s]; none where nobody has declared how late
    /// the instrument's filter makes it.
    pub bound_s: Option<f64>,
    /// What was counted until then.
    pub counts: Counts,
}

/// What a channel brought in a stretch of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brought {
    /// What the channel measures.
    pub quantity: Quantity,
    /// What was counted in it.
    pub counts: Counts,
    /// Its times are at most so far off [s], where that is known.
    pub bound_s: Option<f64>,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.received += other.received;
        self.lost += other.lost;
        self.repeated += other.repeated;
        self.over_range += other.over_range;
        self.damaged += other.damaged;
    }
}

impl Sub for Counts {
    type Output = Self;

    /// What came since an earlier state of the same counts.
    fn sub(self, earlier: Self) -> Self {
        Self {
            received: self.received - earlier.received,
            lost: self.lost - earlier.lost,
            repeated: self.repeated - earlier.repeated,
            over_range: self.over_range - earlier.over_range,
            damaged: self.damaged - earlier.damaged,
        }
    }
}
