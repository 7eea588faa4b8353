//! One attached device: from what happened on its link to records, samples and its status.

use std::sync::Arc;

use devices::channel::{Counted, Counts};
use devices::port::LinkEvent;
use devices::setup::DeviceConfig;
use devices::{Attachment, InstrumentEvent, Sample};
use replay::{
    AttachedDevice, Calibration, Direction, Gap, LinkDecoder, LinkLosses, Loss, LossKind,
    QualityChange, Raw, Record,
};

use super::channel::AttachedChannel;
use super::ended::LeftOff;
use super::error::LiveError;
use crate::page::status::DeviceStatus;

/// A device of the session.
pub(super) struct Attached {
    name: Arc<str>,
    /// Decodes the bytes as a replay will; the thread of the port may know more of the link than
    /// the recording holds.
    decoder: LinkDecoder,
    /// What its adapter may hold back [s].
    latency_s: f64,
    /// Whether the recording follows the link: it saw its opening, or joined it.
    follows: bool,
    /// Whether what happens is still to be told, on the page and in the log.
    tells: bool,
    channels: Vec<AttachedChannel>,
    events: Vec<InstrumentEvent>,
    /// Why samples are missing, until they come again.
    lost_because: Option<String>,
    pub(super) status: DeviceStatus,
}

/// Gaps so long [s] are each told in the log.
const LONG_GAP_S: f64 = 0.5;
/// What one event means.
#[derive(Default)]
pub(super) struct Taken {
    /// For the recorder, in order.
    pub(super) records: Vec<Record>,
    /// For the run finder, in order.
    pub(super) samples: Vec<Sample>,
    /// Where a recording could join the link.
    pub(super) joint: Option<Raw>,
    /// What was counted when the samples came; none of them before it.
    pub(super) counted: Vec<(usize, Counted)>,
}

impl Attached {
    pub(super) fn new(config: &DeviceConfig, latency_s: f64) -> Result<Self, LiveError> {
        let attachment = Attachment { latency_s, device: config.clone() };
        let channels = config.channels.iter().map(|of| AttachedChannel::new(of.quantity));
        Ok(Self {
            name: config.name.as_str().into(),
            decoder: LinkDecoder::new(&attachment)?,
            latency_s,
            follows: true,
            tells: true,
            channels: channels.collect(),
            events: Vec::new(),
            lost_because: None,
            status: DeviceStatus {
                name: config.name.clone(),
                port: config.port.display().to_string(),
                ..DeviceStatus::default()
            },
        })
    }

    /// What the recording says of the device and its channels before the first byte.
    pub(super) fn introduction(
        &self,
        config: &DeviceConfig,
        profile: &str,
        time_s: f64,
    ) -> Result<Vec<Record>, LiveError> {
        let attachment = self.attachment(config);
        let settings = attachment
            .to_text()
            .map_err(|source| LiveError::Attachment { device: config.name.clone(), source })?;
        let device = config.name.clone();
        let port = config.port.display().to_string();
        let profile = profile.to_owned();
        let mut records =
            vec![Record::Device(AttachedDevice { time_s, device, profile, port, settings })];
        for channel in &config.channels {
            let calibration = &channel.calibration;
            records.push(Record::Calibration(Calibration {
                time_s,
                device: config.name.clone(),
                channel: channel.quantity.name().to_owned(),
                by: calibration.by.clone(),
                taken: calibration.at.clone(),
                definition: calibration.to_text(),
            }));
        }
        Ok(records)
    }

    fn attachment(&self, config: &DeviceConfig) -> Attachment {
        Attachment { latency_s: self.latency_s, device: config.clone() }
    }

    /// Whether it is the device of that name.
    pub(super) fn is_named(&self, name: &str) -> bool {
        *self.name == *name
    }

    /// Another recording goes on with the open link, and knows nothing of what was before.
    pub(super) fn begin_again(&mut self, config: &DeviceConfig) -> Result<(), LiveError> {
        self.decoder = LinkDecoder::new(&self.attachment(config))?;
        (self.follows, self.tells) = (false, false);
        let quantities = || config.channels.iter().map(|of| of.quantity);
        if !quantities().eq(self.channels.iter().map(|channel| channel.quantity)) {
            self.channels = quantities().map(AttachedChannel::new).collect();
        }
        self.channels.iter_mut().for_each(AttachedChannel::begin_again);
        Ok(())
    }

    /// What comes next is in the recording before; the mark of that.
    pub(super) fn lead(&mut self, time_s: f64) -> Record {
        self.decoder.lead();
        self.mark(time_s, Direction::Before)
    }

    /// What comes next is the recording's own; the mark of that, where something came before.
    pub(super) fn begin(&mut self, time_s: f64) -> Option<Record> {
        if !self.decoder.leads() {
            return None;
        }
        self.decoder.begin();
        Some(self.mark(time_s, Direction::Begun))
    }

    fn mark(&self, time_s: f64, direction: Direction) -> Record {
        Record::Raw(Raw { device: Arc::clone(&self.name), time_s, direction, bytes: Vec::new() })
    }

    /// What happens from here on was not told yet.
    pub(super) fn tell(&mut self) {
        self.tells = true;
    }

    /// Where its channels are left when its port is closed.
    pub(super) fn left_off(&self) -> impl Iterator<Item = LeftOff> {
        let device = &self.name;
        self.channels.iter().filter_map(|channel| {
            let time_s = channel.last?.sample.time_s;
            Some(LeftOff { device: Arc::clone(device), quantity: channel.quantity, time_s })
        })
    }

    /// Its port was opened anew: samples are missing since its channels were left.
    pub(super) fn leave_off(&mut self, left_off: &[LeftOff]) {
        for LeftOff { device, quantity, time_s } in left_off {
            let own = self.channels.iter_mut().filter(|_| *device == self.name);
            own.filter(|channel| channel.quantity == *quantity)
                .for_each(|channel| channel.left_off_s = Some(*time_s));
        }
    }

    /// Where the recording begins to follow the link, when it does with this event.
    fn joint(&self, link: &LinkEvent) -> Option<LinkEvent> {
        match link {
            LinkEvent::Round { .. } => Some(link.clone()),
            LinkEvent::Received { at_ns, .. } if !self.decoder.asks() => {
                Some(LinkEvent::Round { at_ns: *at_ns, due_ns: *at_ns })
            }
            _ => None,
        }
    }

    /// Takes what happened; what a recording that joins the link cannot understand yet is none of
    /// it.
    pub(super) fn take(
        &mut self,
        link: &LinkEvent,
        now_s: f64,
        losses: &mut LinkLosses,
        taken: &mut Taken,
    ) {
        match link {
            LinkEvent::Opened { .. } => self.follows = true,
            // What was asked or said in between is not known.
            LinkEvent::Overflow { .. } => self.follows = false,
            LinkEvent::Round { .. } if self.follows => {
                taken.joint = Raw::of_link(&self.name, link, now_s);
                return;
            }
            LinkEvent::Round { .. }
            | LinkEvent::Sent { .. }
            | LinkEvent::Waited { .. }
            | LinkEvent::Received { .. }
                if !self.follows =>
            {
                let Some(joint) = self.joint(link) else { return };
                self.follows = true;
                self.take_next(&joint, now_s, losses, taken);
                if joint == *link {
                    return;
                }
            }
            _ => {}
        }
        self.take_next(link, now_s, losses, taken);
    }

    fn take_next(
        &mut self,
        link: &LinkEvent,
        now_s: f64,
        losses: &mut LinkLosses,
        taken: &mut Taken,
    ) {
        taken.records.extend(Raw::of_link(&self.name, link, now_s).map(Record::Raw));
        self.note_link(link);
        let mut events = std::mem::take(&mut self.events);
        self.decoder.take(link, &mut events);
        if self.decoder.leads() {
            self.events = events;
            return;
        }
        let before: Vec<Counts> = self.channels.iter().map(|channel| channel.counts).collect();
        for (channel, (_, counts)) in self.channels.iter_mut().zip(self.decoder.counts()) {
            channel.counts = counts;
        }
        taken.counted.extend(self.decoder.counted().map(|counted| (0, counted)));
        let mut missing = 0;
        for event in &events {
            taken.samples.extend(event.usable_sample());
            losses.push(&self.name, event);
            missing += self.meaning(event, now_s, taken);
            if self.tells {
                self.tell_of(event);
            }
        }
        events.clear();
        self.events = events;
        for (channel, before) in self.channels.iter_mut().zip(before) {
            let mut more = channel.counts - before;
            // Those that a gap tells are not lost twice.
            more.lost = more.lost.saturating_sub(missing);
            let losses = [
                (LossKind::Lost, more.lost),
                (LossKind::Repeated, more.repeated),
                (LossKind::OverRange, more.over_range),
                (LossKind::Damaged, more.damaged),
            ];
            let lost = losses.into_iter().filter(|(_, count)| *count > 0);
            taken.records.extend(lost.map(|(kind, count)| {
                let (device, channel) = (self.name.to_string(), channel.quantity.name().to_owned());
                Record::Loss(Loss { time_s: now_s, device, channel, kind, count })
            }));
        }
    }

    fn note_link(&mut self, link: &LinkEvent) {
        if let LinkEvent::Overflow { n_events } = link {
            self.lost_because = Some(format!("{n_events} events of the port found no place"));
            if self.tells {
                self.status.n_dropped += n_events;
                let device = &*self.name;
                tracing::error!(device, n_events, "events of the port found no place");
            }
        }
    }

    /// Appends what an event means to the recorder; samples missing, where it tells of some.
    fn meaning(&mut self, event: &InstrumentEvent, now_s: f64, taken: &mut Taken) -> u64 {
        let device = &*self.name;
        match event {
            InstrumentEvent::Sample(measured) => {
                let Sample { quantity, time_s, value } = measured.sample;
                let channels = self.channels.iter_mut();
                for channel in channels.filter(|channel| channel.quantity == quantity) {
                    let reason = "the ports were opened anew for another campaign file";
                    let gap = channel.left_off_s.take().map(|left_s| Gap {
                        time_s: now_s,
                        device: device.to_owned(),
                        channel: quantity.name().to_owned(),
                        start_s: left_s,
                        end_s: time_s,
                        lost: None,
                        reason: reason.to_owned(),
                    });
                    taken.records.extend(gap.map(Record::Gap));
                    let change = channel.change(measured).map(|flags| QualityChange {
                        time_s,
                        device: device.to_owned(),
                        channel: quantity.name().to_owned(),
                        flags,
                    });
                    taken.records.extend(change.map(Record::Quality));
                    if self.tells {
                        channel.remember(measured);
                    }
                }
                if value.is_finite() {
                    taken.records.push(Record::Sample(measured.sample));
                }
            }
            InstrumentEvent::Gap { from_s, to_s, n_missing } => {
                let reason = self.lost_because.take();
                let reason = reason.unwrap_or_else(|| "samples are missing".to_owned());
                taken.records.extend(self.channels.iter().map(|channel| {
                    Record::Gap(Gap {
                        time_s: now_s,
                        device: device.to_owned(),
                        channel: channel.quantity.name().to_owned(),
                        start_s: *from_s,
                        end_s: *to_s,
                        lost: *n_missing,
                        reason: reason.clone(),
                    })
                }));
                if self.tells {
                    self.status.n_gaps += 1;
                    let n_gaps = self.status.n_gaps;
                    // A bad line may lose a sample a second all day.
                    if to_s - from_s >= LONG_GAP_S || n_gaps.is_power_of_two() {
                        tracing::warn!(device, from_s, to_s, n_missing, n_gaps, "gap: {reason}");
                    }
                }
                return n_missing.unwrap_or(0);
            }
            InstrumentEvent::LinkLost { seen, .. } => {
                self.lost_because = Some(format!("the link was lost: {seen}"));
            }
            InstrumentEvent::Restarted { .. } => {
                self.lost_because = Some("the instrument started anew".to_owned());
            }
            _ => {}
        }
        0
    }

    /// Tells on the page and in the log what an event means, once.
    fn tell_of(&mut self, event: &InstrumentEvent) {
        let device = &*self.name;
        match event {
            InstrumentEvent::Sample(_) => self.status.trouble = None,
            InstrumentEvent::Linked { .. } => {
                self.status.linked = true;
                tracing::info!(device, port = self.status.port, "linked");
            }
            InstrumentEvent::LinkLost { seen, .. } => {
                self.status.linked = false;
                self.status.n_losses += 1;
                self.status.trouble.clone_from(&self.lost_because);
                tracing::error!(device, port = self.status.port, seen, "link lost");
            }
            InstrumentEvent::Restarted { at_s } => {
                tracing::warn!(device, at_s, "the instrument started anew");
            }
            InstrumentEvent::Identity(text) => {
                if self.status.identity.replace(text.clone()).as_ref() != Some(text) {
                    tracing::info!(device, identity = text, "says who it is");
                }
            }
            InstrumentEvent::Trouble(trouble) => {
                let hint = trouble.hint().unwrap_or_default();
                tracing::error!(device, hint, "{trouble}");
                self.status.trouble = Some(trouble.to_string());
            }
            InstrumentEvent::Gap { .. } | InstrumentEvent::Overflow { .. } => {}
        }
    }

    /// The device as it is now.
    pub(super) fn status(&self) -> DeviceStatus {
        DeviceStatus {
            channels: self.channels.iter().map(AttachedChannel::status).collect(),
            ..self.status.clone()
        }
    }
}
