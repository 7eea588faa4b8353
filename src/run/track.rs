//! Keeps the samples of one channel as long as a run may still need them.

use std::collections::VecDeque;

use super::Series;
use super::bins::Bin;
use super::bins::Binner;

/// A hole that is longer than this many usual sample intervals is more than jitter.
const N_INTERVALS_IN_HOLE: f64 = 4.5;
/// A hole shorter than this [s] is too short to matter to any roll.
const HOLE_MIN_S: f64 = 0.1;

/// The last samples of a channel with their bins.
#[derive(Debug, Clone, Default)]
pub(super) struct Track {
    time_s: VecDeque<f64>,
    value: VecDeque<f64>,
    bins: VecDeque<Bin>,
    binner: Binner,
    last_s: Option<f64>,
    interval_s: f64,
}

impl Track {
    /// Time of the last sample [s].
    pub(super) fn last_s(&self) -> Option<f64> {
        self.last_s
    }

    /// The last sample's time [s] when a sample at `time_s` would leave a hole behind it.
    pub(super) fn hole_before(&self, time_s: f64) -> Option<f64> {
        let last_s = self.last_s?;
        let limit_s = (N_INTERVALS_IN_HOLE * self.interval_s).max(HOLE_MIN_S);
        (self.interval_s > 0.0 && time_s - last_s > limit_s).then_some(last_s)
    }

    /// Takes a sample, never earlier than the last one; gives the bin that it completes.
    pub(super) fn push(&mut self, time_s: f64, value: f64) -> Option<Bin> {
        if let Some(last_s) = self.last_s.replace(time_s) {
            let interval_s = time_s - last_s;
            // The first interval counts whole, later ones slowly, and a hole as little as jitter.
            self.interval_s = if self.interval_s == 0.0 {
                interval_s
            } else {
                self.interval_s + 0.02 * (interval_s.min(3.0 * self.interval_s) - self.interval_s)
            };
        }
        self.time_s.push_back(time_s);
        self.value.push_back(value);
        let bin = self.binner.push(time_s, value);
        self.bins.extend(bin);
        bin
    }

    /// Whether a bin holds more than one sample.
    pub(super) fn averages(&self) -> bool {
        self.interval_s < super::bins::WIDTH_S
    }

    /// Starts a new bin, because the next sample does not follow the last one.
    pub(super) fn interrupt(&mut self) {
        self.binner = Binner::default();
    }

    /// Drops what is older than `time_s`.
    pub(super) fn forget_before(&mut self, time_s: f64) {
        let n = self.time_s.partition_point(|&t| t < time_s);
        self.time_s.drain(..n);
        self.value.drain(..n);
        let n = self.bins.partition_point(|b| b.time_s < time_s);
        self.bins.drain(..n);
    }

    /// Number of samples kept.
    pub(super) fn n_samples(&self) -> usize {
        self.time_s.len()
    }

    /// The samples from `start_s` to `end_s`, both included.
    pub(super) fn series(&self, start_s: f64, end_s: f64) -> Series {
        let from = self.time_s.partition_point(|&t| t < start_s);
        let to = self.time_s.partition_point(|&t| t <= end_s).max(from);
        Series {
            time_s: self.time_s.range(from..to).copied().collect(),
            value: self.value.range(from..to).copied().collect(),
        }
    }

    /// The bins from `start_s` to `end_s`, both included.
    pub(super) fn bins(
        &self,
        start_s: f64,
        end_s: f64,
    ) -> impl DoubleEndedIterator<Item = Bin> + Clone + '_ {
        let from = self.bins.partition_point(|b| b.time_s < start_s);
        let to = self.bins.partition_point(|b| b.time_s <= end_s).max(from);
        self.bins.range(from..to).copied()
    }

    /// Standard deviation of the samples from `start_s` to `end_s` about `mean`.
    pub(super) fn sd(&self, start_s: f64, end_s: f64, mean: f64) -> f64 {
        let from = self.time_s.partition_point(|&t| t < start_s);
        let to = self.time_s.partition_point(|&t| t <= end_s).max(from);
        let squares = self.value.range(from..to).map(|value| (value - mean).powi(2));
        (squares.sum::<f64>() / (to - from).max(1) as f64).sqrt()
    }

    /// Mean of the bins from `start_s` to `end_s`, where there are any.
    pub(super) fn mean(&self, start_s: f64, end_s: f64) -> Option<f64> {
        let bins = self.bins(start_s, end_s);
        let n = bins.clone().count();
        (n > 0).then(|| bins.map(|b| b.value).sum::<f64>() / n as f64)
    }
}
