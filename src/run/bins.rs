//! Averages a channel into bins of about a twentieth of a second, whatever its sample rate.

/// Mean time and mean value of a few successive samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bin {
    /// Mean time [s].
    pub(super) time_s: f64,
    /// Mean value.
    pub(super) value: f64,
}

/// A bin is full when the next sample would come this long [s] after its first; a 20 Hz channel
/// with some jitter keeps each sample, and a roll period of 0.5 s keeps ten bins.
pub(super) const WIDTH_S: f64 = 0.045;

/// Collects samples until a bin is full.
#[derive(Debug, Clone, Default)]
pub(super) struct Binner {
    first_s: f64,
    elapsed_sum_s: f64,
    value_sum: f64,
    n: usize,
}

impl Binner {
    /// Takes a sample, later than the last one; gives the bin that ended before it.
    pub(super) fn push(&mut self, time_s: f64, value: f64) -> Option<Bin> {
        let full = (self.n > 0 && time_s - self.first_s >= WIDTH_S).then(|| self.mean());
        if full.is_some() || self.n == 0 {
            *self = Self { first_s: time_s, ..Self::default() };
        }
        self.elapsed_sum_s += time_s - self.first_s;
        self.value_sum += value;
        self.n += 1;
        full
    }

    fn mean(&self) -> Bin {
        let n = self.n as f64;
        Bin { time_s: self.first_s + self.elapsed_sum_s / n, value: self.value_sum / n }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n_bins(rate_hz: f64) -> usize {
        let mut binner = Binner::default();
        (0..(10.0 * rate_hz) as usize)
            .filter_map(|k| binner.push(k as f64 / rate_hz, 1.0))
            .inspect(|bin| assert!((bin.value - 1.0).abs() < 1e-12))
            .count()
    }

    #[test]
    fn twenty_hertz_and_five_kilohertz_both_give_about_twenty_bins_a_second() {
        assert_eq!(n_bins(20.0), 199);
        assert!((200..=222).contains(&n_bins(5000.0)));
    }
}
