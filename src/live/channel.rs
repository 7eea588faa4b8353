//! One channel of an attached device: its counts, and what it read lately.

use std::collections::VecDeque;

use devices::channel::{Counts, zero_from_readings};
use devices::{Measured, Quality, Quantity};

use crate::page::status::{ChannelStatus, RecentRaw};

/// Raw readings so old [s] are forgotten; a zero is taken from those before.
const RECENT_S: f64 = 5.0;

/// A channel of an attached device.
pub(super) struct AttachedChannel {
    pub(super) quantity: Quantity,
    /// What was counted in this recording.
    pub(super) counts: Counts,
    pub(super) last: Option<Measured>,
    /// Times [s] and raw readings of the last seconds.
    recent: VecDeque<(f64, f64)>,
    /// What the recording says of the quality of its samples.
    quality: Quality,
    /// Its last sample before its port was opened anew [s], until the first after it.
    pub(super) left_off_s: Option<f64>,
}

impl AttachedChannel {
    /// A channel that has brought nothing yet.
    pub(super) fn new(quantity: Quantity) -> Self {
        let (counts, recent) = (Counts::default(), VecDeque::new());
        Self { quantity, counts, last: None, recent, quality: Quality::GOOD, left_off_s: None }
    }

    /// Another recording begins, which knows nothing of what was before.
    pub(super) fn begin_again(&mut self) {
        (self.counts, self.quality) = (Counts::default(), Quality::GOOD);
    }

    /// The flags of a sample, where they are not those of the one before in the recording.
    pub(super) fn change(&mut self, measured: &Measured) -> Option<String> {
        let before = std::mem::replace(&mut self.quality, measured.quality);
        let names = || self.quality.names().collect::<Vec<_>>().join(", ");
        (before != self.quality).then(names)
    }

    /// Takes a sample that it brought.
    pub(super) fn remember(&mut self, measured: &Measured) {
        self.last = Some(*measured);
        let time_s = measured.sample.time_s;
        if measured.quality.is_usable() {
            self.recent.push_back((time_s, measured.raw));
        }
        while self.recent.front().is_some_and(|(at_s, _)| *at_s < time_s - RECENT_S) {
            self.recent.pop_front();
        }
    }

    /// Mean and standard deviation of the raw readings of the last seconds, and how many they are.
    fn recent(&self) -> Option<RecentRaw> {
        let raw: Vec<f64> = self.recent.iter().map(|(_, raw)| *raw).collect();
        let (mean, sd) = zero_from_readings(&raw).ok()?;
        Some(RecentRaw { n_readings: raw.len(), mean, sd })
    }

    /// The channel as it is now.
    pub(super) fn status(&self) -> ChannelStatus {
        ChannelStatus {
            quantity: self.quantity,
            unit: self.quantity.unit(),
            value: self.last.map(|last| last.sample.value),
            time_s: self.last.map(|last| last.sample.time_s),
            quality: self.last.map_or(Quality::GOOD, |last| last.quality).names().collect(),
            bound_s: self.last.map(|last| last.bound_s),
            recent: self.recent(),
            counts: self.counts,
        }
    }
}
