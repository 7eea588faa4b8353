//! A whole recording in a bounded number of points, by the extremes of each stretch.

use devices::{Quantity, Sample};

use crate::results::Overview;
use crate::run::Series;

/// Stretches kept of a channel: two to the pixel on a wide page, so that no peak is lost.
const N_STRETCHES: usize = 2048;

/// Collects the overview of one recording as its samples pass.
#[derive(Debug, Default)]
pub(super) struct OverviewBuilder {
    roll: Extremes,
    speed: Extremes,
    drive: Extremes,
}

impl OverviewBuilder {
    pub(super) fn push(&mut self, sample: &Sample) {
        match sample.quantity {
            Quantity::Roll => self.roll.push(sample.time_s, sample.value),
            Quantity::Speed => self.speed.push(sample.time_s, sample.value),
            Quantity::Force | Quantity::Moment => self.drive.push(sample.time_s, sample.value),
        }
    }

    /// The overview of what has passed so far.
    pub(super) fn so_far(&self, recording: &str, notes: Vec<String>) -> Overview {
        Overview {
            recording: recording.to_owned(),
            roll: self.roll.series(),
            speed: self.speed.series(),
            drive: self.drive.series(),
            notes,
        }
    }
}

/// Lowest and highest value of equal counts of samples; the count doubles when space runs out.
#[derive(Debug)]
struct Extremes {
    stretches: Vec<Stretch>,
    samples_per_stretch: usize,
    samples_in_last: usize,
}

impl Default for Extremes {
    fn default() -> Self {
        Self { stretches: Vec::new(), samples_per_stretch: 1, samples_in_last: 0 }
    }
}

#[derive(Debug, Clone, Copy)]
struct Stretch {
    /// Time and value of the lowest sample.
    low: (f64, f64),
    /// Time and value of the highest sample.
    high: (f64, f64),
}

impl Stretch {
    fn merged(self, other: Self) -> Self {
        Self {
            low: if other.low.1 < self.low.1 { other.low } else { self.low },
            high: if other.high.1 > self.high.1 { other.high } else { self.high },
        }
    }
}

impl Extremes {
    fn push(&mut self, time_s: f64, value: f64) {
        let one = Stretch { low: (time_s, value), high: (time_s, value) };
        match self.stretches.last_mut() {
            Some(last) if self.samples_in_last < self.samples_per_stretch => {
                *last = last.merged(one);
                self.samples_in_last += 1;
            }
            _ => {
                if self.stretches.len() == N_STRETCHES {
                    self.halve();
                }
                self.stretches.push(one);
                self.samples_in_last = 1;
            }
        }
    }

    fn halve(&mut self) {
        let halved = self.stretches.chunks(2);
        self.stretches = halved
            .map(|pair| pair.iter().copied().reduce(Stretch::merged).expect("a chunk is not empty"))
            .collect();
        self.samples_per_stretch *= 2;
    }

    fn series(&self) -> Series {
        let mut series = Series::default();
        for &Stretch { low, high } in &self.stretches {
            let (first, second) = if low.0 <= high.0 { (low, high) } else { (high, low) };
            for (time_s, value) in [first, second] {
                if series.time_s.last().is_none_or(|&last| last < time_s) {
                    series.time_s.push(time_s);
                    series.value.push(value);
                }
            }
        }
        series
    }
}

#[cfg(test)]
mod tests {
    use super::{Extremes, N_STRETCHES};

    #[test]
    fn a_short_record_is_kept_sample_by_sample() {
        let mut extremes = Extremes::default();
        for k in 0..100 {
            extremes.push(f64::from(k), f64::from(k % 7));
        }
        let series = extremes.series();
        assert_eq!(series.value, (0..100).map(|k| f64::from(k % 7)).collect::<Vec<_>>());
    }

    #[test]
    fn a_long_record_keeps_its_one_spike_in_bounded_space() {
        let mut extremes = Extremes::default();
        for k in 0..1_000_000 {
            extremes.push(f64::from(k), if k == 777_777 { 9.0 } else { 0.0 });
        }
        let series = extremes.series();
        assert!(series.value.len() <= 2 * N_STRETCHES);
        let spike = series.value.iter().position(|&value| value > 8.0).expect("the spike");
        assert!((series.time_s[spike] - 777_777.0).abs() < 0.5);
        assert!(series.time_s.is_sorted());
    }
}
