//! When a reading was taken, on the host's clock, and how well that is known.

use crate::clock::{
    ClockLine, Counter, CounterStep, Envelope, Missing, NS_PER_S, Paced, Rhythm, TickSteps,
};
use crate::driver::{DeviceTicks, Taken};

/// Device time may differ from the host's by this much per elapsed second, and still be a clock.
const DRIFT_MAX: f64 = 0.01;
/// Arrivals may be late by this much [s] before the instrument is taken to have restarted.
const LATE_MAX_S: f64 = 2.0;
/// The same where a sequence number that counted on says that it did not restart.
const LATE_COUNTED_MAX_S: f64 = 60.0;
/// Device time between two looks at the estimator [s].
const LINE_EVERY_S: f64 = 0.1;

/// What the stamps of one device need to know of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StampSettings {
    pub(crate) ticks: DeviceTicks,
    pub(crate) sends_hz: Option<f64>,
    /// The adapter may hold bytes back so long [s].
    pub(crate) latency_s: f64,
    /// A fetched reading may be so old [s].
    pub(crate) age_s: f64,
    /// The filter makes readings late by so much [s], give or take so much.
    pub(crate) lag_s: f64,
    pub(crate) lag_bound_s: f64,
}

/// Keeps a device's counters and clock.
pub(crate) struct Stamper {
    settings: StampSettings,
    sequence: Option<Counter>,
    ticks: Option<Counter>,
    paced: Option<Paced>,
    /// Steps of the ticks, where nothing else counts samples.
    steps: TickSteps,
    /// The beat of the arrivals, where the instrument gives no number at all.
    rhythm: Rhythm,
    envelope: Envelope,
    line: Option<ClockLine>,
    line_at_s: f64,
    last_arrival_s: Option<f64>,
}

/// The stamp of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stamp {
    pub(crate) time_s: f64,
    /// The time is at most so far off [s].
    pub(crate) bound_s: f64,
    pub(crate) sequence: Option<u64>,
    /// Samples missing before it.
    pub(crate) n_missing: u64,
    /// Where they are missing [s], if not right before it.
    pub(crate) missing_between_s: Option<[f64; 2]>,
    /// By the instrument's own numbers, so that no loss can hide.
    pub(crate) is_numbered: bool,
    /// The instrument's counters started anew.
    pub(crate) restarted: bool,
    /// The same frame came before.
    pub(crate) repeated: bool,
}

impl Stamper {
    pub(crate) fn new(settings: StampSettings) -> Self {
        Self {
            settings,
            sequence: settings.ticks.sequence_bits.map(Counter::new),
            ticks: settings.ticks.time_bits.map(Counter::new),
            paced: settings.sends_hz.map(Paced::new),
            steps: TickSteps::default(),
            rhythm: Rhythm::default(),
            envelope: Envelope::new(settings.latency_s),
            line: None,
            line_at_s: f64::NEG_INFINITY,
            last_arrival_s: None,
        }
    }

    /// The link was away: a device without numbers of its own may have lost any of them.
    pub(crate) fn reopened(&mut self) {
        if self.sequence.is_none() && self.ticks.is_none() {
            self.forget_clock();
        }
    }

    fn forget_clock(&mut self) {
        self.envelope = Envelope::new(self.settings.latency_s);
        self.line = None;
        self.line_at_s = f64::NEG_INFINITY;
        self.paced = self.settings.sends_hz.map(Paced::new);
        self.rhythm = Rhythm::default();
        self.last_arrival_s = None;
    }

    pub(crate) fn stamp(
        &mut self,
        sequence: Option<u64>,
        ticks: Option<u64>,
        taken: Taken,
    ) -> Stamp {
        let mut stamp = Stamp {
            time_s: 0.0,
            bound_s: 0.0,
            sequence: None,
            n_missing: 0,
            missing_between_s: None,
            is_numbered: self.sequence.is_some() || self.ticks.is_some(),
            restarted: false,
            repeated: false,
        };
        if let (Some(counter), Some(value)) = (&mut self.sequence, sequence) {
            let (continued, step) = counter.sequence(value);
            stamp.sequence = Some(continued);
            match step {
                CounterStep::Skipped(n_missing) => stamp.n_missing = n_missing,
                CounterStep::Repeated => stamp.repeated = true,
                CounterStep::Restarted => stamp.restarted = true,
                CounterStep::First | CounterStep::Next => {}
            }
        }
        if stamp.repeated {
            return stamp;
        }
        let (time_s, bound_s) = match taken {
            Taken::Arrived(at_ns) => self.arrived(at_ns as f64 / NS_PER_S, ticks, &mut stamp),
            Taken::Held(from_ns, to_ns) => middle(from_ns, to_ns, 0.0),
            Taken::Between(from_ns, to_ns) => middle(from_ns, to_ns, self.settings.age_s),
        };
        let lag_s = self.settings.lag_s;
        stamp.missing_between_s = stamp.missing_between_s.map(|at_s| at_s.map(|at_s| at_s - lag_s));
        stamp.time_s = time_s - lag_s;
        stamp.bound_s = bound_s + self.settings.lag_bound_s;
        stamp
    }

    fn arrived(&mut self, arrival_s: f64, ticks: Option<u64>, stamp: &mut Stamp) -> (f64, f64) {
        let Some(device_s) = self.device_s(arrival_s, ticks, stamp) else {
            let half_s = self.settings.latency_s / 2.0;
            if let Some(Missing { n_samples, between_s }) = self.rhythm.next(arrival_s) {
                stamp.n_missing += n_samples;
                stamp.missing_between_s = Some(between_s.map(|at_s| at_s - half_s));
            }
            return (arrival_s - half_s, half_s);
        };
        self.last_arrival_s = Some(arrival_s);
        self.envelope.push(device_s, arrival_s);
        if self.line.is_none() || (device_s - self.line_at_s).abs() >= LINE_EVERY_S {
            self.line = self.envelope.line();
            self.line_at_s = device_s;
        }
        match &self.line {
            Some(line) => (line.host_s(device_s), line.bound_s),
            None => (arrival_s, self.settings.latency_s),
        }
    }

    /// The device's own time, by its ticks or by counting samples.
    fn device_s(&mut self, arrival_s: f64, ticks: Option<u64>, stamp: &mut Stamp) -> Option<f64> {
        if self.ticks.is_none() {
            let (device_s, n_missing) = self.paced.as_mut()?.next(arrival_s, self.line.as_ref());
            stamp.n_missing += n_missing;
            return Some(device_s);
        }
        if stamp.restarted {
            self.forget_clock();
        }
        let per_s = self.settings.ticks.ticks_per_s;
        let elapsed_s = arrival_s - self.last_arrival_s.unwrap_or(arrival_s);
        let counted = stamp.sequence.is_some() && !stamp.restarted;
        let late_max_s = if counted { LATE_COUNTED_MAX_S } else { LATE_MAX_S };
        let tolerance_s = late_max_s + DRIFT_MAX * elapsed_s;
        let counter = self.ticks.as_mut()?;
        let value = ticks?;
        match counter.ticks(value, elapsed_s * per_s, tolerance_s * per_s) {
            Some(continued) if !stamp.restarted => {
                self.step(continued, stamp);
                Some(continued as f64 / per_s)
            }
            continued => {
                stamp.restarted = true;
                self.steps = TickSteps::default();
                if continued.is_some() {
                    // A restart by the sequence number: the ticks begin a new line as well.
                    self.ticks = self.settings.ticks.time_bits.map(Counter::new);
                    self.ticks.as_mut()?.ticks(value, 0.0, 0.0);
                }
                self.forget_clock();
                Some(value as f64 / per_s)
            }
        }
    }

    /// What the ticks say of losses and repeats where no sequence number does.
    fn step(&mut self, continued: u64, stamp: &mut Stamp) {
        if self.sequence.is_some() {
            return;
        }
        match self.steps.next(continued) {
            CounterStep::Skipped(n_missing) => stamp.n_missing += n_missing,
            CounterStep::Repeated => stamp.repeated = true,
            CounterStep::First | CounterStep::Next | CounterStep::Restarted => {}
        }
    }
}

/// The middle of an interval and half its width, for a reading that was up to `age_s` old.
fn middle(from_ns: u64, to_ns: u64, age_s: f64) -> (f64, f64) {
    let from_s = from_ns as f64 / NS_PER_S - age_s;
    let to_s = to_ns as f64 / NS_PER_S;
    (f64::midpoint(from_s, to_s), (to_s - from_s) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamper(ticks: DeviceTicks) -> Stamper {
        let settings = StampSettings {
            ticks,
            sends_hz: None,
            latency_s: 0.016,
            age_s: 0.01,
            lag_s: 0.002,
            lag_bound_s: 0.0,
        };
        Stamper::new(settings)
    }

    #[test]
    fn a_fetched_reading_lies_between_its_request_and_its_answer() {
        let mut stamper = stamper(DeviceTicks::default());
        let stamp = stamper.stamp(None, None, Taken::Between(1_000_000_000, 1_004_000_000));
        // Up to 10 ms old at the request: the middle of 0.990 and 1.004, less 2 ms of lag.
        assert!((stamp.time_s - 0.995).abs() < 1e-9 && (stamp.bound_s - 0.007).abs() < 1e-9);
        let held = stamper.stamp(None, None, Taken::Held(2_000_000_000, 2_001_000_000));
        assert!((held.time_s - 1.9985).abs() < 1e-9 && (held.bound_s - 0.0005).abs() < 1e-9);
    }

    #[test]
    fn a_stall_of_seconds_is_no_restart_of_a_board_that_counted_on() {
        let ticks = DeviceTicks { sequence_bits: Some(32), time_bits: Some(32), ticks_per_s: 1e6 };
        let mut stamper = stamper(ticks);
        for index in 0..2000_u64 {
            // What was sent in ten to fifteen seconds comes all at once.
            let sent_ns = 5_000_000_000 + index * 10_000_000;
            let stalled = (15_000_000_000..20_000_000_000).contains(&sent_ns);
            let arrived_ns = if stalled { 20_000_000_000 } else { sent_ns };
            let arrived = Taken::Arrived(arrived_ns);
            let stamp = stamper.stamp(Some(index), Some(index * 10_000), arrived);
            let truth_s = sent_ns as f64 / 1e9 - 0.002;
            assert!((stamp.time_s - truth_s).abs() < 1e-6, "{index}: {stamp:?}");
            assert!(!stamp.restarted && stamp.n_missing == 0);
        }
    }

    #[test]
    fn a_restarted_board_begins_a_new_line() {
        let ticks = DeviceTicks { sequence_bits: Some(32), time_bits: Some(32), ticks_per_s: 1e6 };
        let mut stamper = stamper(ticks);
        for index in 0..500_u64 {
            let arrived = Taken::Arrived(5_000_000_000 + index * 10_000_000);
            let stamp = stamper.stamp(Some(index), Some(index * 10_000), arrived);
            let truth_s = 5.0 + index as f64 * 0.01 - 0.002;
            assert!((stamp.time_s - truth_s).abs() < 1e-9, "{index}: {stamp:?}");
            assert!(!stamp.restarted && stamp.n_missing == 0);
        }
        let stamp = stamper.stamp(Some(0), Some(1500), Taken::Arrived(12_000_000_000));
        assert!(stamp.restarted && (stamp.time_s - 11.998).abs() < 1e-9, "{stamp:?}");
        let stamp = stamper.stamp(Some(1), Some(11_500), Taken::Arrived(12_014_000_000));
        assert!(!stamp.restarted && (stamp.time_s - 12.008).abs() < 1e-9, "{stamp:?}");
    }
}
