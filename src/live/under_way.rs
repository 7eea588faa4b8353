//! A recording under way: the loop that takes every event in turn.

use std::collections::BTreeMap;
use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use devices::clock::{Clock, WallClock};
use devices::port::{LinkEvent, LinkThread};
use devices::{Quantity, Sample};
use replay::{LinkLosses, Note};
use tokio::sync::mpsc::Receiver;

use super::attached::{Attached, Taken};
use super::ended::{Ended, Over, Reload, keeps_links};
use super::error::no_devices;
use super::event::Event;
use super::keeping::Keeper;
use super::provisional::Offers;
use super::supervisor::Supervisor;
use super::telling::{Begun, Decided};
use crate::campaign::{self, Campaign, FILE_NAME};
use crate::page::status::RecordedStatus;
use crate::page::{Board, Order};
use crate::pipeline::{Found, LiveRuns};
use crate::procedure::CALM_DEG;
use crate::settling::Settling;

/// How often time is told to the loop.
const TICK: Duration = Duration::from_millis(50);
/// Ticks from one forecast of the calm to the next.
const TICKS_PER_FORECAST: u64 = 20;
/// Without a sample of roll for so long [s] nothing can be under way.
const ROLL_AWAY_S: f64 = 10.0;
/// Rest [s] before a new campaign file comes into force: a model that is heeled for its release is
/// held no longer than that without a movement.
const RELOAD_REST_S: f64 = 1.0;
/// A recording that a full disk has stopped, or prevented, is not followed by another before [s].
const BEGIN_AGAIN_S: f64 = 5.0;
/// Rest [s] before one recording gives way to the next for its length alone.
const ROTATE_REST_S: f64 = 30.0;

/// A recording under way.
pub(super) struct UnderWay<'a> {
    pub(super) campaign: &'a Campaign,
    pub(super) clock: &'a Arc<WallClock>,
    pub(super) board: &'a Board,
    pub(super) supervisor: &'a mut Supervisor,
    pub(super) keeper: Keeper,
    /// Where samples go, until the recording has ended.
    pub(super) runs: Option<LiveRuns<'a>>,
    /// Where the run under way is offered before its end is known.
    pub(super) offers: Offers,
    /// Told to whoever works for this recording when it ends.
    pub(super) is_ending: &'a AtomicBool,
    /// Age [s] at which the recording gives way to the next when the model is at rest.
    pub(super) rotate_s: f64,
    /// Whether it is known what earlier recordings taught; before, no other can begin.
    pub(super) knows_earlier: &'a AtomicBool,
    pub(super) state: State,
}

/// What changes from event to event.
#[derive(Default)]
pub(super) struct State {
    pub(super) attached: Vec<Attached>,
    /// The threads of the ports, until the recording ends.
    pub(super) ports: Vec<LinkThread>,
    /// How the water calms between runs.
    pub(super) settling: Option<Settling>,
    /// Ticks of the clock so far.
    pub(super) n_ticks: u64,
    /// What each strip shows.
    pub(super) strips: Vec<Quantity>,
    pub(super) losses: LinkLosses,
    pub(super) found: Vec<Found>,
    pub(super) taken: Taken,
    /// The run that is under way, as it was when it was last looked at.
    pub(super) begun: Option<Begun>,
    pub(super) n_begun: u64,
    /// Runs that have ended and are still to be reported.
    pub(super) decided: BTreeMap<u64, Decided>,
    pub(super) began_ns: u64,
    /// When the model last moved, and when a sample of its roll last came [ns].
    pub(super) moved_ns: u64,
    pub(super) roll_ns: u64,
    pub(super) n_events: u64,
    pub(super) reload: Option<Box<Reload>>,
    /// The end that somebody wants at once.
    pub(super) wanted: Option<Ended>,
    pub(super) ended: Option<Ended>,
    pub(super) all_reported: bool,
}

impl UnderWay<'_> {
    /// Takes events until the recording has ended and every run of it was reported.
    pub(super) async fn record(
        mut self,
        mut events: Receiver<Event>,
        orders: &mut Receiver<Order>,
    ) -> Over {
        let mut ticks = tokio::time::interval(TICK);
        ticks.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
        loop {
            let event = tokio::select! {
                Some(event) = events.recv() => event,
                // Once the links are the next session's, whatever anybody wants is too.
                Some(order) = orders.recv(), if !self.hands_over() => Event::Order(order),
                _ = ticks.tick() => Event::Tick,
            };
            self.state.n_events += 1;
            match event {
                Event::Link { device, link } => self.link(device, &link),
                Event::Reported(reported) => self.reported(*reported),
                Event::AllReported => self.state.all_reported = true,
                Event::Order(Order::Terminate) => self.end(Ended::Terminated),
                Event::Order(Order::Reload) => self.read_again(),
                Event::Order(Order::TellAgain) => {
                    self.runs.iter().for_each(LiveRuns::tell_again);
                }
                Event::Order(Order::StopRecording { by }) => {
                    self.state.wanted = self.keeper.records().then_some(Ended::Paused(by));
                }
                Event::Order(Order::StartRecording) => {
                    self.state.wanted = (!self.keeper.records()).then_some(Ended::Resumed);
                }
                Event::Tick => self.tick(),
            }
            // The ports were closed when the end began, so that nothing comes behind these.
            // Links that are handed over never fall silent; what they bring is the next session's.
            if self.hands_over() || self.state.ended.is_some() && events.is_empty() {
                self.end_runs();
            }
            if self.state.all_reported
                && let Some(ended) = self.state.ended.take()
            {
                self.renew_status();
                let State { attached, ports, .. } = self.state;
                let remembered = self.keeper.take_remembered();
                let (mut links, mut left_off) = (None, Vec::new());
                if ended.hands_over() {
                    links = Some(((attached, ports, remembered), events));
                } else {
                    left_off = attached.iter().flat_map(Attached::left_off).collect();
                }
                return Over { ended, keeper: self.keeper, links, left_off };
            }
        }
    }

    /// Whether the links are the next session's already.
    fn hands_over(&self) -> bool {
        self.state.ended.as_ref().is_some_and(Ended::hands_over)
    }

    fn link(&mut self, device: usize, link: &LinkEvent) {
        let now_ns = self.clock.now_ns();
        let taken = self.taken(device, link, now_ns);
        self.show(&taken.samples);
        self.find_runs(taken, link.at_ns().unwrap_or(now_ns));
    }

    /// Takes what happened on a link before this recording was asked for; pages have shown it.
    pub(super) fn link_before(&mut self, device: usize, link: &LinkEvent) {
        let now_ns = self.clock.now_ns();
        let at_ns = link.at_ns().unwrap_or(now_ns);
        let taken = self.taken(device, link, at_ns);
        self.find_runs(taken, at_ns);
    }

    /// Records what happened on a link; gives what it means.
    fn taken(&mut self, device: usize, link: &LinkEvent, now_ns: u64) -> Taken {
        let mut taken = std::mem::take(&mut self.state.taken);
        if let Some(attached) = self.state.attached.get_mut(device) {
            attached.take(link, now_ns as f64 / 1e9, &mut self.state.losses, &mut taken);
        }
        taken.joint.take().into_iter().for_each(|joint| self.keeper.remember(joint));
        taken.records.drain(..).for_each(|record| self.keeper.push(record));
        taken
    }

    /// Hands samples to the run finder, and tells what it has found.
    fn find_runs(&mut self, mut taken: Taken, at_ns: u64) {
        self.samples(&taken, at_ns);
        taken.samples.clear();
        taken.counted.clear();
        self.state.taken = taken;
    }

    /// Hands samples to the page, in the units in which people read them.
    fn show(&mut self, samples: &[Sample]) {
        let settling = self.state.settling.get_or_insert_with(|| Settling::new(CALM_DEG));
        for sample in samples.iter().filter(|sample| sample.quantity == Quantity::Roll) {
            settling.push(sample.time_s, sample.value);
        }
        let mut strips = self.board.strips();
        for &Sample { quantity, time_s, value } in samples {
            let shown = if quantity == Quantity::Roll { value.to_degrees() } else { value };
            if let Some(strip) = self.state.strips.iter().position(|of| *of == quantity) {
                strips.push(strip, time_s, shown);
            }
        }
        drop(strips);
        self.board.change(|status| {
            for sample in samples {
                match sample.quantity {
                    Quantity::Roll => status.motion.push(sample.time_s, sample.value),
                    Quantity::Speed => status.pass.push(sample.time_s, sample.value),
                    Quantity::Force | Quantity::Moment => {}
                }
            }
        });
    }

    fn samples(&mut self, Taken { samples, counted, .. }: &Taken, at_ns: u64) {
        if samples.iter().any(|sample| sample.quantity == Quantity::Roll) {
            self.state.roll_ns = at_ns;
        }
        // What is not recorded would be missing in a replay.
        let Some(runs) = self.runs.as_mut().filter(|_| self.keeper.records()) else { return };
        runs.push(samples, counted, &mut self.state.found);
        if !runs.is_at_rest() {
            self.state.moved_ns = at_ns;
        }
        self.take_found(at_ns);
        self.offer(samples, at_ns);
    }

    /// Offers the run under way by the newest sample of its roll.
    fn offer(&mut self, samples: &[Sample], at_ns: u64) {
        let rolls = samples.iter().rev().find(|sample| sample.quantity == Quantity::Roll);
        let (Some(runs), Some(roll)) = (&self.runs, rolls) else { return };
        let mut seen = None;
        self.offers.offer(roll.time_s, at_ns, || {
            let so_far = runs.so_far();
            seen = Some(so_far.as_ref().map(Begun::of));
            so_far
        });
        if let Some(begun) = seen {
            self.take_so_far(begun);
        }
    }

    /// Hands the links over, or closes the ports, unless they are; the rest follows when their last
    /// events were taken.
    fn end(&mut self, ended: Ended) {
        if matches!(ended, Ended::Terminated) {
            self.supervisor.stopping();
        }
        if self.state.ended.is_none() || matches!(ended, Ended::Terminated) {
            self.state.ended = Some(ended);
        }
        self.is_ending.store(true, Ordering::Release);
        if self.hands_over() {
            return self.keeper.cut();
        }
        self.state.ports.iter().for_each(LinkThread::stop);
        self.state.ports.clear();
    }

    /// The last event of the last port was taken.
    fn end_runs(&mut self) {
        // Without a recording nothing has ended; the telling end notes that this one is gone.
        let is_recorded = self.keeper.records() || self.keeper.broke_off();
        let Some(runs) = self.runs.take().filter(|_| is_recorded) else { return };
        let mut notes: Vec<Note> = Vec::new();
        self.state.losses.notes(&mut notes);
        self.read_clocks();
        runs.end(notes, &mut self.state.found);
        self.take_found(self.clock.now_ns());
        self.break_off();
    }

    /// Reads the campaign file again; a wrong one changes nothing.
    fn read_again(&mut self) {
        self.supervisor.reloading();
        let folder = &self.campaign.folder;
        let text = fs::read_to_string(folder.join(FILE_NAME)).unwrap_or_default();
        let none = || vec![no_devices(folder)];
        let read = campaign::read(folder);
        let read =
            read.and_then(|read| if read.live.devices.is_empty() { Err(none()) } else { Ok(read) });
        match read {
            Ok(campaign) => {
                tracing::info!("the new campaign file is in force from the next rest on");
                let keeps_links = keeps_links(&self.campaign.live.devices, &campaign.live.devices);
                self.state.reload = Some(Box::new(Reload { campaign, text, keeps_links }));
                self.board.change(|status| {
                    status.reload_waits = true;
                    status.refused_reload = None;
                });
            }
            Err(mistakes) => {
                for mistake in &mistakes {
                    let hint = mistake.hint.clone().unwrap_or_default();
                    tracing::error!(hint, "the campaign file stays as it was: {mistake}");
                }
                let told: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
                self.board.change(|status| status.refused_reload = Some(told.join("; ")));
            }
        }
        // From here on the daemon follows the file by itself, at the next rest.
        self.supervisor.ready("recording");
    }

    fn tick(&mut self) {
        let now_ns = self.clock.now_ns();
        self.state.n_ticks += 1;
        self.keeper.tick(self.clock.real(now_ns));
        self.supervisor.alive(self.clock.real(now_ns));
        if let Some(ended) = self.due(now_ns) {
            self.end(ended);
        }
        self.renew_status();
    }

    /// The end that is due, if any.
    fn due(&mut self, now_ns: u64) -> Option<Ended> {
        let since_s = |at_ns: u64| now_ns.saturating_sub(at_ns) as f64 / 1e9;
        let state = &mut self.state;
        if state.ended.is_some() || !self.knows_earlier.load(Ordering::Acquire) {
            return None;
        }
        if let Some(wanted) = state.wanted.take() {
            return Some(wanted);
        }
        // What comes from here on belongs to the next recording, once there is room.
        if self.keeper.broke_off() {
            return Some(Ended::BrokenOff);
        }
        let roll_is_away = since_s(state.roll_ns) > ROLL_AWAY_S;
        let rested_s = if roll_is_away { f64::INFINITY } else { since_s(state.moved_ns) };
        if rested_s < RELOAD_REST_S {
            return None;
        }
        if let Some(reload) = state.reload.take() {
            return Some(Ended::Reloaded(reload));
        }
        let age_s = since_s(state.began_ns);
        if age_s >= BEGIN_AGAIN_S && self.keeper.may_begin_again() {
            return Some(Ended::RoomAgain);
        }
        let is_long = age_s >= self.rotate_s && rested_s >= ROTATE_REST_S && !roll_is_away;
        // On a full disk no other could begin.
        (is_long && self.keeper.records()).then_some(Ended::Rotated)
    }

    fn renew_status(&mut self) {
        let progress = self.keeper.progress();
        let (state, at_s) = (&self.state, self.clock.now_ns() as f64 / 1e9);
        let n_unheard = self.runs.as_ref().map_or(0, LiveRuns::n_unheard);
        let is_due = state.n_ticks.is_multiple_of(TICKS_PER_FORECAST);
        let calm = state.settling.as_ref().filter(|_| is_due).map(Settling::calm);
        let at_rest = self.runs.as_ref().is_none_or(LiveRuns::is_at_rest);
        self.board.change(|status| {
            status.at_s = at_s;
            status.motion.note_rest(at_rest, at_s);
            status.calm = calm.or(status.calm);
            status.n_events = state.n_events;
            status.devices = state.attached.iter().map(Attached::status).collect();
            status.runs.n_unheard = status.runs.n_unheard.max(n_unheard);
            status.recorded = RecordedStatus {
                records: progress.records,
                unrecorded: progress.unrecorded,
                part_bytes: progress.part_bytes,
                stopped: progress.stopped,
            };
        });
    }
}
