//! Finds runs in the stream of samples.

use std::collections::VecDeque;

use devices::{Quantity, Sample};

use super::Event;
use super::Limits;
use super::Run;
use super::RunEnd;
use super::aftermath::Following;
use super::closer::Closer;
use super::half_cycles::HalfCycles;
use super::half_cycles::QUIET_MIN_S;
use super::half_cycles::Swing;
use super::motion::Motion;
use super::passed_over::PassedOver;
use super::records::KEPT_S;
use super::records::LEAD_S;
use super::records::Records;

/// Samples kept per channel: beyond it a run is closed, so that memory stays within some 100 MB.
const N_SAMPLES_MAX: usize = 2_000_000;
/// Longest time [s] that the roll waits for a channel that lags behind or has stopped, or that a
/// run waits for the roll.
const WAIT_MAX_S: f64 = 4.0;
/// Share of a half period up to which a hole in the roll does not end a run.
const HOLE_SHARE: f64 = 0.25;

/// Finds runs in samples pushed one by one; the same samples give the same events, however cut.
#[derive(Debug, Clone)]
pub struct RunFinder {
    limits: Limits,
    records: Records,
    half_cycles: HalfCycles,
    motion: Motion,
    /// What the model does after its last release.
    following: Option<Following>,
    passed_over: PassedOver,
    /// What the roll did while it is not yet known how the carriage moved.
    waiting: VecDeque<Swing>,
    quiet_since_s: Option<f64>,
    half_period_s: Option<f64>,
    n_since_forgotten: usize,
}

impl RunFinder {
    /// A finder at the start of a recording.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            records: Records::default(),
            half_cycles: HalfCycles::default(),
            motion: Motion::default(),
            following: None,
            passed_over: PassedOver::default(),
            waiting: VecDeque::new(),
            quiet_since_s: None,
            half_period_s: None,
            n_since_forgotten: 0,
        }
    }

    /// Takes the next sample and appends what is known because of it.
    pub fn push(&mut self, sample: &Sample, events: &mut Vec<Event>) {
        let last_s = match sample.quantity {
            Quantity::Roll => self.records.roll.last_s(),
            Quantity::Force | Quantity::Moment => self.records.drive.track.last_s(),
            Quantity::Speed => self.records.carriage.track.last_s(),
        };
        if !self.passed_over.admits(sample, last_s, events) {
            return;
        }
        match sample.quantity {
            Quantity::Roll => self.push_roll(sample.time_s, sample.value, events),
            Quantity::Force | Quantity::Moment => {
                self.records.drive.push(sample.time_s, sample.value);
                self.notice_silence(sample.time_s, events);
            }
            Quantity::Speed => {
                self.records.carriage.push(sample.time_s, sample.value);
                self.notice_silence(sample.time_s, events);
            }
        }
        self.settle(events);
        self.n_since_forgotten += 1;
        if self.n_since_forgotten >= 1000 {
            self.forget(events);
        }
    }

    /// Whether neither a run nor any motion is under way, so that nothing is lost by ending here.
    pub fn is_at_rest(&self) -> bool {
        self.waiting.is_empty() && self.half_cycles.is_quiet()
    }

    /// The run under way as the end of the recording would make it now, if it would.
    pub fn so_far(&self) -> Option<Run> {
        if self.is_at_rest() {
            return None;
        }
        let (mut ended, mut events) = (self.clone(), Vec::new());
        ended.finish(&mut events);
        events.into_iter().rev().find_map(|event| match event {
            Event::Run(run) => Some(run),
            Event::Rejected(_) | Event::Aftermath(_) => None,
        })
    }

    /// The recording has ended: closes whatever was under way.
    pub fn finish(&mut self, events: &mut Vec<Event>) {
        self.drain(events);
        if let Some(end_s) = self.records.roll.last_s() {
            self.end(RunEnd::RecordingEnded, end_s, events);
        }
        self.passed_over.flush(events);
    }

    fn push_roll(&mut self, time_s: f64, roll_rad: f64, events: &mut Vec<Event>) {
        if let Some(last_s) = self.records.roll.hole_before(time_s) {
            let bearable_s = self.half_period_s.map_or(0.0, |half_s| HOLE_SHARE * half_s);
            if time_s - last_s > bearable_s {
                self.break_off(last_s, events);
            }
        }
        let Some(bin) = self.records.push_roll(time_s, roll_rad) else { return };
        let was_quiet = self.half_cycles.is_quiet();
        let swing = self.half_cycles.push(bin, self.records.ripple());
        match swing {
            Some(Swing::Quiet(at_s)) => {
                self.half_period_s = None;
                self.quiet_since_s = Some(at_s - QUIET_MIN_S);
            }
            Some(Swing::Half(half)) => self.half_period_s = Some(half.duration_s()),
            None => {}
        }
        self.waiting.extend(swing);
        if self.half_cycles.is_quiet() {
            self.quiet_since_s.get_or_insert(bin.time_s);
        } else if was_quiet && let Some(start_s) = self.quiet_since_s.take() {
            let left_s = self.half_cycles.turn().map_or(bin.time_s, |turn| turn.left_s);
            if left_s - start_s >= 1.0 {
                self.records.note_still(start_s, left_s);
            }
        }
    }

    /// The roll instrument may be gone for hours, and the run that it left is known to be over.
    fn notice_silence(&mut self, time_s: f64, events: &mut Vec<Event>) {
        let Some(last_s) = self.records.roll.last_s() else { return };
        if time_s - last_s > WAIT_MAX_S && !self.is_at_rest() {
            self.break_off(last_s, events);
        }
    }

    /// A hole in the roll ends whatever was under way at its last sample.
    fn break_off(&mut self, last_s: f64, events: &mut Vec<Event>) {
        self.drain(events);
        self.end(RunEnd::Gap, last_s, events);
        self.records.interrupt_roll();
        self.half_cycles = HalfCycles::default();
        (self.quiet_since_s, self.half_period_s) = (None, None);
    }

    /// Passes on what the roll did as soon as it is known how carriage and rod moved then.
    fn settle(&mut self, events: &mut Vec<Event>) {
        while let Some(swing) = self.waiting.front() {
            let at_s = match swing {
                Swing::Half(half) => half.end.time_s,
                Swing::Quiet(at_s) => *at_s,
            };
            let waited_s = self.records.roll.last_s().unwrap_or(at_s) - at_s;
            let drive_is_behind = self.records.drive.track.last_s().is_some_and(|s| s < at_s);
            let known =
                waited_s >= WAIT_MAX_S || self.records.carriage.is_known(at_s) && !drive_is_behind;
            if !known {
                return;
            }
            self.pass_on(events);
        }
    }

    fn drain(&mut self, events: &mut Vec<Event>) {
        while !self.waiting.is_empty() {
            self.pass_on(events);
        }
    }

    fn pass_on(&mut self, events: &mut Vec<Event>) {
        let Self { records, limits, following, motion, waiting, .. } = self;
        let mut closer = Closer { records, limits, events, following };
        match waiting.pop_front() {
            Some(Swing::Half(half)) => motion.half_cycle(half, &mut closer),
            Some(Swing::Quiet(at_s)) => motion.quiet(at_s, &mut closer),
            None => {}
        }
    }

    /// Ends whatever is under way.
    fn end(&mut self, end: RunEnd, end_s: f64, events: &mut Vec<Event>) {
        let Self { records, limits, following, motion, .. } = self;
        motion.end(end, end_s, &mut Closer { records, limits, events, following });
    }

    /// Drops samples that no run can need any more.
    fn forget(&mut self, events: &mut Vec<Event>) {
        self.n_since_forgotten = 0;
        let Some(now_s) = self.records.roll.last_s().or(self.records.drive.track.last_s()) else {
            return;
        };
        if self.records.n_samples() > N_SAMPLES_MAX {
            self.drain(events);
            self.end(RunEnd::TooLong, now_s, events);
        }
        if self.following.is_some_and(|following| following.is_over(now_s)) {
            let Self { records, limits, following, .. } = self;
            Closer { records, limits, events, following }.leave();
        }
        let waiting_s = self.waiting.iter().find_map(|swing| match swing {
            Swing::Half(half) => Some(half.start.time_s),
            Swing::Quiet(_) => None,
        });
        let turn_s = self.half_cycles.turn().map(|turn| turn.time_s);
        let followed_s = self.following.map(|following| following.needed_from_s());
        let needed = [self.motion.needed_from_s(), followed_s, waiting_s, turn_s];
        let first_s = needed.into_iter().flatten().reduce(f64::min);
        let from_s = first_s.map_or(f64::INFINITY, |first_s| first_s - LEAD_S);
        self.records.forget_before(from_s.min(now_s - KEPT_S));
    }
}

#[cfg(test)]
mod tests {
    use super::super::RunKind;
    use super::*;

    const LIMITS: Limits = Limits {
        carriage_max_speed_m_s: None,
        declared_speed_m_s: None,
        length_pp_m: 2.5,
        gravity_m_s2: 9.81,
    };

    /// Feeds roll and force at 20 Hz; gives the events and the most samples kept of a channel.
    fn feed(duration_s: f64, roll_and_force: impl Fn(f64) -> (f64, f64)) -> (Vec<Event>, usize) {
        let mut finder = RunFinder::new(LIMITS);
        let (mut events, mut n_most) = (Vec::new(), 0);
        for k in 0..(duration_s * 20.0) as usize {
            let time_s = k as f64 * 0.05;
            let (roll, force) = roll_and_force(time_s);
            for (quantity, value) in [(Quantity::Roll, roll), (Quantity::Force, force)] {
                finder.push(&Sample { quantity, time_s, value }, &mut events);
            }
            n_most = n_most.max(finder.records.n_samples());
        }
        finder.finish(&mut events);
        (events, n_most)
    }

    #[test]
    fn ten_hours_of_rest_are_forgotten() {
        // Two sines that beat stand for the noise, and the zero drifts by a degree.
        let (events, n_most) = feed(36_000.0, |t| {
            (1e-4 * ((97.0 * t).sin() + (311.0 * t).sin()) + 5e-7 * t, 0.01 * (53.0 * t).sin())
        });
        assert!(events.is_empty(), "{events:?}");
        // Twenty seconds at 20 Hz, and what comes in until the next thousand pushes.
        assert!(n_most < 1500, "{n_most} samples");
    }

    #[test]
    fn forced_rolling_without_end_is_closed_at_the_longest_run() {
        let (events, n_most) =
            feed(7200.0, |t| (0.1 * (3.0 * t).sin(), 4.0 * (3.0 * t + 0.5).sin()));
        let runs: Vec<_> = events
            .iter()
            .filter_map(|event| match event {
                Event::Run(run) => Some((run.kind, run.end, run.end_s - run.start_s)),
                Event::Rejected(_) | Event::Aftermath(_) => None,
            })
            .collect();
        assert_eq!(runs.len(), 4, "{runs:?}");
        for (kind, end, length_s) in &runs[..3] {
            assert_eq!((*kind, *end), (RunKind::Forced, RunEnd::TooLong));
            assert!((1790.0..1810.0).contains(length_s), "{length_s} s");
        }
        // Half an hour at 20 Hz.
        assert!(n_most < 38_000, "{n_most} samples");
    }

    #[test]
    fn a_roll_instrument_that_is_gone_ends_its_run_while_others_go_on() {
        let mut finder = RunFinder::new(LIMITS);
        let mut events = Vec::new();
        let told_s = (0..4000).map(|k| f64::from(k) * 0.02).find(|&time_s| {
            let free_s = (time_s - 5.0).max(0.0);
            let value = 0.2 * (-0.2 * free_s).exp() * (6.0 * free_s).cos();
            let ripple = 2e-4 * (97.0 * time_s).sin();
            let roll = Sample { quantity: Quantity::Roll, time_s, value: value + ripple };
            // The cable is pulled at 12 s and put back a minute later.
            if !(12.0..72.0).contains(&time_s) {
                finder.push(&roll, &mut events);
            }
            let speed = Sample { quantity: Quantity::Speed, time_s, value: 0.01 * ripple };
            finder.push(&speed, &mut events);
            !events.is_empty()
        });
        assert!(matches!(&events[0], Event::Run(run) if run.end == RunEnd::Gap), "{events:?}");
        assert!(told_s.is_some_and(|told_s| (16.0..16.1).contains(&told_s)), "{told_s:?}");
        assert!(finder.is_at_rest());
    }

    #[test]
    fn a_model_held_on_a_carriage_that_shakes_it_is_free_when_it_is_let_go() {
        let mut finder = RunFinder::new(LIMITS);
        let mut events = Vec::new();
        for k in 0..3000 {
            let time_s = f64::from(k) * 0.01;
            let speed_m_s = (0.5 * (time_s - 6.0)).clamp(0.0, 1.0);
            let shaking = 1.1e-3 * speed_m_s * (18.2 * time_s).sin();
            let free_s = (time_s - 14.0).max(0.0);
            let heel = 0.19 * ((time_s - 6.0) / 1.5).clamp(0.0, 1.0);
            let roll = heel * (-0.3 * free_s).exp() * (6.9 * free_s).cos() + shaking;
            let ripple = 2e-4 * (97.0 * time_s).sin();
            for (quantity, value) in [(Quantity::Roll, roll), (Quantity::Speed, speed_m_s)] {
                let value = value + ripple;
                finder.push(&Sample { quantity, time_s, value }, &mut events);
            }
        }
        finder.finish(&mut events);
        let Some(Event::Run(run)) = events.first() else { panic!("{events:?}") };
        assert!((run.start_s - 14.0).abs() < 0.2, "{} s", run.start_s);
    }

    #[test]
    fn a_run_is_told_as_soon_as_its_end_is_known() {
        let mut finder = RunFinder::new(LIMITS);
        let mut events = Vec::new();
        let told_s = (0..2000).map(|k| f64::from(k) * 0.02).find(|&time_s| {
            let free_s = time_s - 5.0;
            let value = match free_s {
                ..0.0 => 0.2,
                0.0..8.0 => 0.2 * (-0.2 * free_s).exp() * (6.0 * free_s).cos(),
                _ => 0.0,
            };
            let ripple = 2e-4 * (97.0 * time_s).sin();
            let sample = Sample { quantity: Quantity::Roll, time_s, value: value + ripple };
            finder.push(&sample, &mut events);
            !events.is_empty()
        });
        assert!(matches!(&events[0], Event::Run(run) if run.end == RunEnd::Caught), "{events:?}");
        // The model is still from 13 s on, which takes 1.2 half periods to tell.
        assert!(told_s.is_some_and(|s| s < 14.5), "{told_s:?}");
    }
}
