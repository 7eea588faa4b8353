//! The instruments of a session: attached anew, or taken over with the last seconds they brought.

use std::sync::Arc;

use devices::clock::{Clock, WallClock};
use devices::port::LinkThread;
use devices::{AttachedInstrument, Instrument, Quantity};
use replay::{CampaignFile, ClockReading, Raw, Record};
use tokio::sync::mpsc::{self, Receiver, Sender};

use super::attached::Attached;
use super::ended::LeftOff;
use super::error::LiveError;
use super::event::{EVENTS_WAITING, Event};
use super::remembered::Remembered;
use super::under_way::UnderWay;

/// What goes over from one session to the next: no byte is lost between.
pub(super) struct TakenOver {
    pub(super) attached: Vec<Attached>,
    pub(super) ports: Vec<LinkThread>,
    /// What happened on the links lately.
    pub(super) remembered: Remembered,
    /// Where their threads send what happens, and where that is taken.
    pub(super) events: (Sender<Event>, Receiver<Event>),
}

/// Instruments of the session before.
pub(super) type Before = (Vec<Attached>, Vec<LinkThread>, Remembered);

impl TakenOver {
    /// Links with the receiving end of their events, and the sending one.
    pub(super) fn new(
        ((attached, ports, remembered), receiver): (Before, Receiver<Event>),
        sender: Sender<Event>,
    ) -> Self {
        Self { attached, ports, remembered, events: (sender, receiver) }
    }

    /// What is taken over, if anything, and the queue of events, a new one if need be.
    pub(super) fn or_new(
        taken_over: Option<Self>,
    ) -> (Option<Before>, (Sender<Event>, Receiver<Event>)) {
        match taken_over {
            Some(Self { attached, ports, remembered, events }) => {
                (Some((attached, ports, remembered)), events)
            }
            None => (None, mpsc::channel(EVENTS_WAITING)),
        }
    }
}

impl UnderWay<'_> {
    /// Attaches every device, unless the session before hands it over, and records what is known of
    /// them.
    pub(super) fn attach(
        &mut self,
        events: &Sender<Event>,
        text: String,
        before: Option<Before>,
        left_off: &[LeftOff],
    ) -> Result<(), LiveError> {
        let now_ns = self.clock.now_ns();
        self.state.began_ns = now_ns;
        (self.state.moved_ns, self.state.roll_ns) = (now_ns, now_ns);
        let begins_s = before.as_ref().and_then(|(_, _, remembered)| remembered.begins_s());
        let time_s = begins_s.unwrap_or(now_ns as f64 / 1e9);
        self.keeper.push(Record::Campaign(CampaignFile { time_s, text }));
        self.read_clocks();
        let mut remembered = None;
        match before {
            Some((attached, ports, before)) => {
                (self.state.attached, self.state.ports) = (attached, ports);
                remembered = Some(before);
            }
            None => self.open_ports(events)?,
        }
        let live = &self.campaign.live;
        for (attached, config) in self.state.attached.iter_mut().zip(&live.devices) {
            let of_name = live.setups.iter().find(|setup| setup.name == config.name);
            let profile = of_name.map_or("", |setup| setup.profile.as_str());
            for record in attached.introduction(config, profile, time_s)? {
                self.keeper.push(record);
            }
            if remembered.is_some() {
                attached.begin_again(config)?;
            }
            attached.leave_off(left_off);
        }
        self.supervisor.ready("recording");
        self.show_instruments();
        if let Some(mut remembered) = remembered {
            let [recorded, unrecorded] = remembered.pour();
            self.repeat(&recorded);
            self.links_before(&unrecorded);
        }
        self.state.attached.iter_mut().for_each(Attached::tell);
        let recording = self.campaign.recordings.last().map_or("", |last| last.name.as_str());
        tracing::info!(recording, "session begun");
        Ok(())
    }

    /// Takes what is in the recording before, and marks it as such.
    fn repeat(&mut self, recorded: &[Raw]) {
        self.keeper.lead(true);
        for attached in &mut self.state.attached {
            let first = recorded.iter().find(|raw| attached.is_named(&raw.device));
            if let Some(first) = first {
                self.keeper.mark(attached.lead(first.time_s));
            }
        }
        self.links_before(recorded);
        self.keeper.lead(false);
        let ends_s = recorded.last().map_or(0.0, |last| last.time_s);
        for attached in &mut self.state.attached {
            if let Some(begun) = attached.begin(ends_s) {
                self.keeper.mark(begun);
            }
        }
    }

    fn links_before(&mut self, raws: &[Raw]) {
        for raw in raws {
            let named = |attached: &Attached| attached.is_named(&raw.device);
            let device = self.state.attached.iter().position(named);
            if let Some((device, link)) = device.zip(raw.link_event()) {
                self.link_before(device, &link);
            }
        }
    }

    fn open_ports(&mut self, events: &Sender<Event>) -> Result<(), LiveError> {
        for (device, config) in self.campaign.live.devices.iter().enumerate() {
            let clock = Arc::clone(self.clock) as Arc<dyn Clock>;
            let events = events.clone();
            let outlet = move |link| events.try_send(Event::Link { device, link }).is_ok();
            let AttachedInstrument { thread, latency_s, .. } =
                Instrument::attach(config, clock, Box::new(outlet))?;
            self.state.ports.push(thread);
            self.state.attached.push(Attached::new(config, latency_s)?);
        }
        Ok(())
    }

    fn show_instruments(&mut self) {
        let (campaign, state) = (self.campaign, &self.state);
        let live = &campaign.live;
        self.board.change(|status| {
            status.campaign.clone_from(&campaign.name);
            status.condition.clone_from(&live.condition);
            let recording = campaign.recordings.last();
            status.recording = recording.map_or(String::new(), |last| last.name.clone());
            status.n_sessions += 1;
            status.tank_length_m = campaign.tank.length_m;
            status.froude_one_m_s = campaign.hull.speed_m_s(1.0, &campaign.water);
            status.devices = state.attached.iter().map(Attached::status).collect();
            status.reload_waits = false;
        });
        let channels = live.devices.iter().flat_map(|device| &device.channels);
        let strips: Vec<Quantity> = channels.map(|channel| channel.quantity).collect();
        let clock_speed = 1.0 / self.clock.real(1_000_000_000).as_secs_f64();
        let names = strips.iter().map(|quantity| quantity.name()).collect();
        self.board.strips().go_on(names, clock_speed);
        self.state.strips = strips;
    }

    /// Both clocks at once: what differs between two such records is a step or a drift.
    pub(super) fn read_clocks(&mut self) {
        let monotonic_ns = self.clock.now_ns();
        self.keeper.push(Record::Clock(ClockReading {
            time_s: monotonic_ns as f64 / 1e9,
            monotonic_ns,
            realtime_ns: u64::try_from(WallClock::unix_ns()).unwrap_or_default(),
            tai_offset_s: WallClock::tai_offset_s(),
        }));
    }
}
