//! The instruments of a session: attached anew, or taken over with the last seconds they brought.

use std::sync::Arc;

use devices::clock::{Clock, WallClock};
use devices::port::LinkThread;
use devices::{AttachedInstrument, Instrument, Quantity};
use replay::{CampaignFile, ClockReading, PreTrigger, Record};
use tokio::sync::mpsc::{self, Receiver, Sender};

use super::attached::Attached;
use super::error::LiveError;
use super::event::{EVENTS_WAITING, Event};
use super::under_way::UnderWay;

/// What goes over from a session that is not recorded to the one that is: no byte is lost between.
pub(super) struct TakenOver {
    pub(super) attached: Vec<Attached>,
    pub(super) ports: Vec<LinkThread>,
    /// What happened on the links lately, oldest first.
    pub(super) ring: PreTrigger,
    /// Where their threads send what happens, and where that is taken.
    pub(super) events: (Sender<Event>, Receiver<Event>),
}

/// Instruments of the session before.
pub(super) type Before = (Vec<Attached>, Vec<LinkThread>, PreTrigger);

impl TakenOver {
    /// Links with the receiving end of their events, and the sending one.
    pub(super) fn new(
        ((attached, ports, ring), receiver): (Before, Receiver<Event>),
        sender: Sender<Event>,
    ) -> Self {
        Self { attached, ports, ring, events: (sender, receiver) }
    }

    /// What is taken over, if anything, and the queue of events, a new one if need be.
    pub(super) fn or_new(
        taken_over: Option<Self>,
    ) -> (Option<Before>, (Sender<Event>, Receiver<Event>)) {
        match taken_over {
            Some(Self { attached, ports, ring, events }) => (Some((attached, ports, ring)), events),
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
    ) -> Result<(), LiveError> {
        let now_ns = self.clock.now_ns();
        self.state.began_ns = now_ns;
        (self.state.moved_ns, self.state.roll_ns) = (now_ns, now_ns);
        let begins_s = before.as_ref().and_then(|(_, _, ring)| ring.begins_s());
        let time_s = begins_s.unwrap_or(now_ns as f64 / 1e9);
        self.keeper.push(Record::Campaign(CampaignFile { time_s, text }));
        self.read_clocks();
        let mut ring = None;
        match before {
            Some((attached, ports, before)) => {
                (self.state.attached, self.state.ports) = (attached, ports);
                ring = Some(before);
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
            if ring.is_some() {
                attached.begin_again(config)?;
            }
        }
        self.supervisor.ready("recording");
        self.show_instruments();
        for record in ring.iter_mut().flat_map(PreTrigger::pour) {
            let Record::Raw(raw) = record else { continue };
            let named = |attached: &Attached| attached.is_named(&raw.device);
            if let Some(device) = self.state.attached.iter().position(named) {
                self.link_before(device, &raw.link_event());
            }
        }
        Ok(())
    }

    fn open_ports(&mut self, events: &Sender<Event>) -> Result<(), LiveError> {
        for (device, config) in self.campaign.live.devices.iter().enumerate() {
            let clock = Arc::clone(self.clock) as Arc<dyn Clock>;
            let events = events.clone();
            let outlet = move |link| events.try_send(Event::Link { device, link }).is_ok();
            let AttachedInstrument { thread, interpreter, latency_s } =
                Instrument::attach(config, clock, Box::new(outlet))?;
            self.state.ports.push(thread);
            self.state.attached.push(Attached::new(config, interpreter, latency_s));
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
