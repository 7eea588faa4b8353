//! Joins half cycles into decays and forced runs.

use super::Event;
use super::RunEnd;
use super::RunKind;
use super::assembly::Stretch;
use super::carriage_pass::Passage;
use super::closer::Closer;
use super::decay;
use super::decay::Verdict;
use super::driven::Driven;
use super::forced;
use super::forced::Cycle;
use super::half_cycles::HalfCycle;
use super::ripple::Ripple;
use super::trust::Trust;
use super::unused::Cause;
use super::unused::Unused;
use super::usable_end;
use super::usable_end::Usable;

/// Half cycles remembered while no run is under way.
const N_REMEMBERED: usize = 48;
/// Longest run [s]; a longer one is closed and another begins.
const RUN_MAX_S: f64 = 1800.0;
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum State {
    #[default]
    Searching,
    Decay,
    Forced,
}

/// The state machine over half cycles.
#[derive(Debug, Clone, Default)]
pub(super) struct Motion {
    state: State,
    /// Half cycles of the run under way, or the last ones.
    cycles: Vec<Cycle>,
    /// The half cycles before the run under way.
    before: Vec<Cycle>,
    /// Half cycles after a forced run that may be a single outlier.
    doubtful: Vec<Cycle>,
    unused: Option<Unused>,
    /// The roll under the rod that no steady run has claimed.
    driven: Driven,
    trust: Trust,
    /// The model has rolled otherwise since it was last still.
    stirred: bool,
    /// Half cycles at the start of the decay on which the hand that rocked it up may still be.
    n_drops_left: usize,
    /// When the rod let the model go [s].
    rod_left_s: Option<f64>,
    /// The rod drove the model, and still may.
    rod_on: bool,
}

impl Motion {
    /// Time [s] from which samples are still needed.
    pub(super) fn needed_from_s(&self) -> Option<f64> {
        let cycles_s = self.cycles.first().map(|c| c.half.start.time_s);
        cycles_s.into_iter().chain(self.driven.needed_from_s()).reduce(f64::min)
    }

    /// Takes the next half cycle.
    pub(super) fn half_cycle(&mut self, half: HalfCycle, closer: &mut Closer) {
        let (start_s, end_s) = (half.start.left_s, half.end.time_s);
        let passage = closer.records.carriage.passage(start_s, end_s);
        let drive = closer.records.drive.swing(end_s, half.duration_s());
        let cycle = Cycle { half, drive, steady: passage == Passage::Steady };
        match (self.state, passage) {
            (State::Decay | State::Forced, Passage::Ends(left_s)) => {
                self.stop(RunEnd::PassEnded, left_s, closer);
                self.search(cycle, closer);
            }
            (State::Decay | State::Forced, Passage::Changing) => {
                self.stop(RunEnd::PassEnded, start_s, closer);
                self.search(cycle, closer);
            }
            (State::Decay, Passage::Steady) => self.decay(cycle, closer),
            (State::Forced, Passage::Steady) => self.forced(cycle, closer),
            (State::Searching, _) => self.search(cycle, closer),
        }
        closer.follow(&cycle);
        let begun_s = match self.state {
            State::Searching => self.driven.needed_from_s(),
            _ => self.cycles.first().map(|c| c.half.start.time_s),
        };
        if begun_s.is_some_and(|start_s| end_s - start_s > RUN_MAX_S) {
            self.end(RunEnd::TooLong, end_s, closer);
        }
    }

    /// The record has a hole, or it ended: whatever was under way ends.
    pub(super) fn end(&mut self, end: RunEnd, end_s: f64, closer: &mut Closer) {
        self.end_runs(end, end_s, closer);
        closer.leave();
    }

    fn end_runs(&mut self, end: RunEnd, end_s: f64, closer: &mut Closer) {
        if self.state != State::Searching {
            // The pass may have ended after the last whole half cycle.
            let last_s = self.cycles.last().map_or(end_s, |c| c.half.end.time_s);
            match closer.records.carriage.passage(last_s, end_s) {
                Passage::Ends(left_s) => self.stop(RunEnd::PassEnded, left_s, closer),
                _ => self.stop(end, end_s, closer),
            }
        }
        self.close_driven(end, f64::INFINITY, None, closer);
        self.flush(f64::INFINITY, closer);
        *self = Self::default();
        if end == RunEnd::Gap {
            self.trust = Trust::behind_hole();
        }
    }

    /// The model is still, or held, at `at_s`.
    pub(super) fn quiet(&mut self, at_s: f64, closer: &mut Closer) {
        let halves = self.halves();
        let due_rad = if halves.is_empty() { 0.0 } else { decay::due_rad(&halves) };
        // A roll that would have shown, had it gone on.
        let ripple = closer.records.ripple();
        let seen_rad = (1.5 * ripple.lost_below_rad).max(ripple.quiet_range_rad());
        let end = match self.state {
            State::Forced => RunEnd::ExcitationChanged,
            State::Searching if self.driven.is_by_rod() => RunEnd::ExcitationChanged,
            _ if due_rad > seen_rad => RunEnd::Caught,
            _ => RunEnd::LostInNoise,
        };
        self.end_runs(end, at_s, closer);
        closer.rest(at_s);
    }

    fn halves(&self) -> Vec<HalfCycle> {
        self.cycles.iter().map(|c| c.half).collect()
    }

    fn search(&mut self, cycle: Cycle, closer: &mut Closer) {
        if !self.driven.goes_on(&cycle) {
            self.close_driven(Driven::end_before(&cycle), f64::INFINITY, None, closer);
        }
        self.trust.note(&self.cycles, &cycle, closer.records);
        let distrust = self.trust.distrust();
        if !self.trust.is_spent(closer.records, cycle.half.end.time_s) {
            self.driven.push(&cycle, self.unused.as_ref(), closer.records);
        }
        self.unused.get_or_insert_with(|| Unused::from_cycle(&cycle, distrust)).extend(&cycle);
        self.rod_on = (self.rod_on && cycle.is_driven()) || self.driven.is_by_rod();
        self.cycles.push(cycle);
        if self.cycles.len() > N_REMEMBERED {
            self.cycles.remove(0);
        }
        let ripple = closer.records.ripple();
        let recorded = closer.records.drive.is_recorded();
        if self.trust.is_spent(closer.records, cycle.half.end.time_s) {
            return;
        }
        if let Some(start) = forced::settled(&self.cycles, recorded, ripple)
            && self.driven.yields_to(&self.cycles[start..], closer.records, ripple)
        {
            self.begin(State::Forced, start, closer);
        } else if distrust.is_none()
            && let Some(start) = self.decay_start(closer)
        {
            self.n_drops_left = if decay::is_rocked_up(&self.halves(), start) { 2 } else { 0 };
            self.begin(State::Decay, start, closer);
        }
    }

    fn begin(&mut self, state: State, start: usize, closer: &mut Closer) {
        self.state = state;
        self.before.clear();
        self.before.extend(self.cycles.drain(..start));
        self.stirred |= start > 0;
        let start_s = self.cycles[0].half.start.time_s;
        if state == State::Forced {
            let steady = std::mem::take(&mut self.cycles);
            self.close_driven(RunEnd::ExcitationChanged, start_s, Some(&steady), closer);
            self.cycles = steady;
        }
        self.driven.cut(start_s);
    }

    /// Ends the roll under the rod that no steady run has claimed, and tells it when it is a run.
    fn close_driven(
        &mut self,
        end: RunEnd,
        until_s: f64,
        next: Option<&[Cycle]>,
        closer: &mut Closer,
    ) {
        let Some(closed) = self.driven.close(until_s, next, closer.records) else { return };
        self.unused.clone_from(&closed.before);
        self.flush(closed.start_s(), closer);
        closer.tell(&closed.stretch(end));
        let end_s = closed.end_s();
        self.cycles.retain(|c| c.half.start.time_s >= end_s - 1e-9);
        self.trust.run_ended(end, closed.last_amplitude_rad());
        let unused = closed.unused_behind(end, &self.cycles);
        (self.unused, self.stirred, self.rod_left_s) = (Some(unused), true, Some(end_s));
    }

    /// Index of the first of the last half cycles that fall one after the other without a drive.
    fn decay_start(&self, closer: &Closer) -> Option<usize> {
        let ripple = closer.records.ripple();
        let begins = |k: &usize| {
            let (a, b) = (&self.cycles[k - 1], &self.cycles[*k]);
            a.steady && b.steady && decay::begins(&a.half, &b.half, ripple)
        };
        let n = self.cycles.len();
        let start = (1..n).rev().take_while(begins).last()? - 1;
        let chain = &self.cycles[start..];
        let driven = chain.last().is_some_and(Cycle::is_driven) || self.driven.is_by_rod();
        (!driven || (!self.rod_on && forced::drive_follows_decay(chain))).then_some(start)
    }

    fn decay(&mut self, cycle: Cycle, closer: &mut Closer) {
        let ripple = closer.records.ripple();
        let halves = self.halves();
        let driven = |c: &Cycle| c.is_driven();
        let grabbed = driven(&cycle)
            && self.cycles.last().is_some_and(driven)
            && !forced::drive_follows_decay(&self.cycles);
        let verdict = decay::judge(&halves, &cycle.half, ripple, self.n_drops_left > 0);
        match verdict {
            _ if grabbed => {
                let end_s = self.cycles.last().map_or(0.0, |c| c.half.start.time_s);
                self.stop(RunEnd::ExcitationChanged, end_s, closer);
                self.search(cycle, closer);
            }
            Verdict::Continues => self.cycles.push(cycle),
            Verdict::DropsFirst => {
                self.n_drops_left = self.n_drops_left.saturating_sub(1);
                self.before.push(self.cycles.remove(0));
                self.cycles.push(cycle);
            }
            Verdict::Ends(end) => {
                self.stop(end, cycle.half.end.time_s, closer);
                self.search(cycle, closer);
            }
        }
        if !closer.records.drive.is_recorded() {
            self.notice_steady_roll(closer);
        }
    }

    /// Without a drive channel a sustained roll is known only by its amplitude.
    fn notice_steady_roll(&mut self, closer: &mut Closer) {
        if self.state != State::Decay {
            return;
        }
        let ripple = closer.records.ripple();
        let all: Vec<Cycle> = self.before.iter().chain(&self.cycles).copied().collect();
        if let Some(start) = forced::settled(&all, false, ripple) {
            let first = self.cycles[0];
            let unused = self.unused.get_or_insert_with(|| Unused::from_cycle(&first, None));
            all[..start].iter().skip(self.before.len()).for_each(|cycle| unused.extend(cycle));
            self.cycles = all;
            self.begin(State::Forced, start, closer);
        }
    }

    fn forced(&mut self, cycle: Cycle, closer: &mut Closer) {
        let ripple = closer.records.ripple();
        self.leave_start_up(&cycle, ripple, closer);
        if forced::continues(&self.cycles, &cycle, ripple) {
            self.cycles.append(&mut self.doubtful);
            self.cycles.push(cycle);
            return;
        }
        self.doubtful.push(cycle);
        if self.doubtful.len() < 2 {
            return;
        }
        let doubtful = std::mem::take(&mut self.doubtful);
        let behind = self.close(RunEnd::ExcitationChanged, cycle.half.end.time_s, closer);
        for cycle in behind.into_iter().chain(doubtful) {
            match self.state {
                State::Searching => self.search(cycle, closer),
                State::Decay => self.decay(cycle, closer),
                State::Forced => self.forced(cycle, closer),
            }
        }
    }

    /// Moves the start of a run forward while its amplitude still creeps under the same drive.
    fn leave_start_up(&mut self, cycle: &Cycle, ripple: Ripple, closer: &mut Closer) {
        let n = forced::n_crept_from(&self.cycles, cycle, ripple);
        if n > 0 {
            let first = self.cycles[0];
            let unused = self.unused.get_or_insert_with(|| Unused::from_cycle(&first, None));
            let crept: Vec<Cycle> = self.cycles.drain(..n).collect();
            unused.extend_by(&crept);
            self.driven.take_back(&crept, closer.records);
        }
    }

    /// Ends the run under way for the reason `end` at `end_s` at the latest; gives the half cycles
    /// behind its usable end, from which another forced run may begin.
    fn close(&mut self, end: RunEnd, end_s: f64, closer: &mut Closer) -> Vec<Cycle> {
        let kind = if self.state == State::Forced { RunKind::Forced } else { RunKind::Decay };
        let mut cycles = std::mem::take(&mut self.cycles);
        let ripple = closer.records.ripple();
        let all = cycles.clone();
        if kind == RunKind::Forced {
            let n = forced::n_not_yet_steady(&cycles, &closer.records.roll, ripple);
            for cycle in cycles.drain(..n) {
                self.unused.get_or_insert_with(|| Unused::from_cycle(&cycle, None)).extend(&cycle);
            }
        }
        let Some(first) = cycles.first() else { return Vec::new() };
        let start_s = match kind {
            RunKind::Decay => decay::start_s(&first.half, &closer.records.roll, ripple)
                .max(self.rod_left_s.take().unwrap_or(f64::NEG_INFINITY)),
            RunKind::Forced => first.half.start.time_s,
        };
        let Usable { end, end_s, left_s, why } =
            usable_end::find(closer.records, kind, &cycles, (end, end_s));
        let touched = matches!(end, RunEnd::Caught | RunEnd::ReStruck);
        let between_touches = self.stirred && touched && !first.half.is_from_hold();
        let stretch =
            Stretch { kind, repeats: true, start_s, end_s, end, cycles: &cycles, between_touches };
        self.stirred = true;
        // Irregular roll is one rejection, not a hundred.
        let irregular = between_touches && self.unused.is_some() && stretch.is_too_short();
        if irregular || self.driven.reclaims(&stretch, closer.records, ripple) {
            self.state = State::Searching;
            self.driven.take_back(&all, closer.records);
            let unused = self.unused.get_or_insert_with(|| Unused::from_cycle(first, None));
            unused.extend_by(&all);
            return Vec::new();
        }
        self.flush(start_s, closer);
        closer.tell(&stretch);
        self.rod_on = kind == RunKind::Forced;
        self.rod_left_s = left_s.filter(|_| self.rod_on);
        match kind {
            RunKind::Forced => self.driven.begin_behind(stretch.used(), closer.records),
            RunKind::Decay => self.driven = Driven::default(),
        }
        let amplitude_rad = cycles.last().map_or(0.0, |c| c.half.amplitude_rad());
        self.trust.run_ended(end, amplitude_rad);
        self.state = State::Searching;
        self.unused = Some(Unused::new(end_s, Cause::After(end, why)));
        let n_used = cycles.iter().take_while(|c| c.half.start.time_s < end_s - 1e-9).count();
        let behind = cycles.split_off(n_used);
        for cycle in &behind {
            closer.follow(cycle);
        }
        if n_used < forced::N_SETTLED {
            // Each round must use up some, so that rounds come to an end.
            self.set_aside(&behind, end_s);
            return Vec::new();
        }
        behind
    }

    /// Ends the run under way, and sets aside what is behind its usable end.
    fn stop(&mut self, end: RunEnd, end_s: f64, closer: &mut Closer) {
        let behind = self.close(end, end_s, closer);
        self.set_aside(&behind, f64::NEG_INFINITY);
        let doubtful = std::mem::take(&mut self.doubtful);
        self.set_aside(&doubtful, f64::NEG_INFINITY);
    }

    fn set_aside(&mut self, cycles: &[Cycle], from_s: f64) {
        if let Some(unused) = &mut self.unused {
            cycles.iter().filter(|c| c.half.end.time_s > from_s).for_each(|c| unused.extend(c));
        }
    }

    fn flush(&mut self, end_s: f64, closer: &mut Closer) {
        closer
            .events
            .extend(self.unused.take().and_then(|unused| unused.close(end_s)).map(Event::Rejected));
    }
}
