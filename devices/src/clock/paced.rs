//! A stand-in for the sequence number of instruments that send at a fixed rate and count nothing.

use super::ClockLine;

/// How long every arrival must be late before samples are declared missing [s].
const LATE_FOR_S: f64 = 1.0;
/// A whole sample is missing when arrivals stay late by more than this part of a period.
const LATE_PERIODS: f64 = 0.75;

/// Counts samples, and notices by lasting lateness that some are missing.
///
/// A stall makes arrivals late for a while and then early again; a missing sample makes all that
/// follow late. So nothing is declared missing before a second of arrivals has been late.
#[derive(Debug, Clone)]
pub struct Paced {
    period_s: f64,
    index: u64,
    least_late_s: f64,
    since_s: f64,
}

impl Paced {
    /// An instrument that sends so often.
    pub fn new(rate_hz: f64) -> Self {
        Self { period_s: 1.0 / rate_hz, index: 0, least_late_s: f64::INFINITY, since_s: 0.0 }
    }

    /// Device time [s] of the sample that arrived then, and how many before it are missing.
    pub fn next(&mut self, arrival_s: f64, line: Option<&ClockLine>) -> (f64, u64) {
        let mut device_s = self.index as f64 * self.period_s;
        let mut n_missing = 0;
        if let Some(line) = line {
            self.least_late_s = self.least_late_s.min(arrival_s - line.host_s(device_s));
            if device_s - self.since_s >= LATE_FOR_S.max(4.0 * self.period_s) {
                if self.least_late_s > LATE_PERIODS * self.period_s {
                    n_missing = (self.least_late_s / self.period_s).round() as u64;
                    self.index += n_missing;
                    device_s = self.index as f64 * self.period_s;
                }
                self.least_late_s = f64::INFINITY;
                self.since_s = device_s;
            }
        }
        self.index += 1;
        (device_s, n_missing)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Envelope;
    use super::*;

    /// Feeds 100 Hz for 20 s, as `lost` and `late_s` say; how many are missing, and the last error.
    fn feed(lost: impl Fn(u32) -> bool, late_s: impl Fn(u32) -> f64) -> (u64, f64) {
        let (mut paced, mut envelope) = (Paced::new(100.0), Envelope::new(0.016));
        let (mut n_missing, mut error_s) = (0, 0.0);
        for index in (0..2000).filter(|index| !lost(*index)) {
            let truth_s = f64::from(index) * 0.01;
            let arrival_s = 5.0 + truth_s + late_s(index);
            let line = envelope.line();
            let (device_s, missing) = paced.next(arrival_s, line.as_ref());
            n_missing += missing;
            envelope.push(device_s, arrival_s);
            error_s = envelope.line().unwrap().host_s(device_s) - 5.0 - truth_s;
        }
        (n_missing, error_s)
    }

    #[test]
    fn a_lost_sample_is_noticed_and_a_stall_is_not_taken_for_one() {
        let (n_missing, error_s) = feed(|index| index == 700 || index == 701, |_| 0.0);
        assert_eq!(n_missing, 2);
        assert!(error_s.abs() < 1e-9, "{error_s}");
        let stall = |index: u32| {
            if (700..720).contains(&index) { f64::from(720 - index) * 0.01 } else { 0.0 }
        };
        assert_eq!(feed(|_| false, stall).0, 0);
    }
}
