//! One attached device: from what happened on its link to records, samples and its status.

use std::collections::VecDeque;
use std::sync::Arc;

use devices::channel::{Counted, Counts, zero_from_readings};
use devices::driver::Session;
use devices::port::LinkEvent;
use devices::setup::DeviceConfig;
use devices::{Attachment, InstrumentEvent, Interpreter, Measured, Quality, Quantity, Sample};
use replay::{AttachedDevice, Calibration, Gap, LinkLosses, Loss, LossKind, Raw, Record};

use super::error::LiveError;
use crate::page::status::{ChannelStatus, DeviceStatus, RecentRaw};

/// A device of the session.
pub(super) struct Attached {
    name: Arc<str>,
    interpreter: Interpreter,
    /// What its adapter may hold back [s].
    latency_s: f64,
    /// Decodes the bytes anew as a replay will, where the recording joins a link that was open; the
    /// thread of the port knows more of it than the recording holds.
    joined: Option<Joined>,
    channels: Vec<AttachedChannel>,
    events: Vec<InstrumentEvent>,
    /// Why samples are missing, until they come again.
    lost_because: Option<String>,
    pub(super) status: DeviceStatus,
}

struct Joined {
    session: Session,
    has_begun: bool,
}

impl Joined {
    /// Where this recording begins to follow the link, when it does with this event.
    fn begins(&mut self, link: &LinkEvent) -> Option<LinkEvent> {
        let at = match link {
            LinkEvent::Opened { .. } | LinkEvent::Round { .. } => link.clone(),
            LinkEvent::Received { at_ns, .. } if !self.session.asks() => {
                LinkEvent::Round { at_ns: *at_ns, due_ns: *at_ns }
            }
            _ => return None,
        };
        self.has_begun = true;
        Some(at)
    }
}

struct AttachedChannel {
    quantity: Quantity,
    counts: Counts,
    last: Option<Measured>,
    /// Times [s] and raw readings of the last seconds.
    recent: VecDeque<(f64, f64)>,
}

/// Gaps so long [s] are each told in the log.
const LONG_GAP_S: f64 = 0.5;
/// Raw readings so old [s] are forgotten; a zero is taken from those before.
const RECENT_S: f64 = 5.0;

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

impl AttachedChannel {
    fn remember(&mut self, measured: &Measured) {
        self.last = Some(*measured);
        let time_s = measured.sample.time_s;
        if measured.quality.is_usable() {
            self.recent.push_back((time_s, measured.raw));
        }
        while self.recent.front().is_some_and(|(at_s, _)| *at_s < time_s - RECENT_S) {
            self.recent.pop_front();
        }
    }

    /// Mean and standard deviation of the raw readings of the last seconds, and how many they are.
    fn recent(&self) -> Option<RecentRaw> {
        let raw: Vec<f64> = self.recent.iter().map(|(_, raw)| *raw).collect();
        let (mean, sd) = zero_from_readings(&raw).ok()?;
        Some(RecentRaw { n_readings: raw.len(), mean, sd })
    }
}

impl Attached {
    pub(super) fn new(config: &DeviceConfig, interpreter: Interpreter, latency_s: f64) -> Self {
        let channel = |quantity| AttachedChannel {
            quantity,
            counts: Counts::default(),
            last: None,
            recent: VecDeque::new(),
        };
        Self {
            name: config.name.as_str().into(),
            interpreter,
            latency_s,
            joined: None,
            channels: config.channels.iter().map(|of| channel(of.quantity)).collect(),
            events: Vec::new(),
            lost_because: None,
            status: DeviceStatus {
                name: config.name.clone(),
                port: config.port.display().to_string(),
                ..DeviceStatus::default()
            },
        }
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
        let (session, interpreter) = self.attachment(config).start()?;
        self.interpreter = interpreter;
        self.joined = Some(Joined { session, has_begun: false });
        self.lost_because = None;
        self.channels.iter_mut().for_each(|channel| channel.counts = Counts::default());
        Ok(())
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
        if let Some(joined) = self.joined.as_mut().filter(|joined| !joined.has_begun) {
            let Some(begins) = joined.begins(link) else { return };
            self.take_next(&begins, now_s, losses, taken);
            if begins == *link {
                return;
            }
        } else if matches!(link, LinkEvent::Round { .. }) {
            taken.joint = Raw::of_link(&self.name, link, now_s);
            return;
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
        match &mut self.joined {
            Some(Joined { session, .. }) => self.interpreter.replay(link, session, &mut events),
            None => self.interpreter.interpret(link, &mut events),
        }
        let before: Vec<Counts> = self.channels.iter().map(|channel| channel.counts).collect();
        for (channel, (_, counts)) in self.channels.iter_mut().zip(self.interpreter.counts()) {
            channel.counts = counts;
        }
        taken.counted.extend(self.interpreter.counted().map(|counted| (0, counted)));
        let mut missing = 0;
        for event in &events {
            taken.samples.extend(event.usable_sample());
            losses.push(&self.name, event);
            missing += self.meaning(event, now_s, taken);
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
            self.status.n_dropped += n_events;
            self.lost_because = Some(format!("{n_events} events of the port found no place"));
            tracing::error!(device = &*self.name, n_events, "events of the port found no place");
        }
    }

    /// Appends what an event means to the recorder; samples missing, where it tells of some.
    fn meaning(&mut self, event: &InstrumentEvent, now_s: f64, taken: &mut Taken) -> u64 {
        let device = &*self.name;
        match event {
            InstrumentEvent::Sample(measured) => {
                self.status.trouble = None;
                if measured.sample.value.is_finite() {
                    taken.records.push(Record::Sample(measured.sample));
                }
                let of = measured.sample.quantity;
                let channels = self.channels.iter_mut().filter(|channel| channel.quantity == of);
                channels.for_each(|channel| channel.remember(measured));
            }
            InstrumentEvent::Gap { from_s, to_s, n_missing } => {
                let reason = self.lost_because.take();
                let reason = reason.unwrap_or_else(|| "samples are missing".to_owned());
                self.status.n_gaps += 1;
                let n_gaps = self.status.n_gaps;
                // A bad line may lose a sample a second all day.
                if to_s - from_s >= LONG_GAP_S || n_gaps.is_power_of_two() {
                    tracing::warn!(device, from_s, to_s, n_missing, n_gaps, "gap: {reason}");
                }
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
                return n_missing.unwrap_or(0);
            }
            InstrumentEvent::Linked { .. } => {
                // A recording that joins an open link hears of its opening again.
                if !std::mem::replace(&mut self.status.linked, true) {
                    tracing::info!(device, port = self.status.port, "linked");
                }
            }
            InstrumentEvent::LinkLost { seen, .. } => {
                self.status.linked = false;
                self.status.n_losses += 1;
                self.lost_because = Some(format!("the link was lost: {seen}"));
                self.status.trouble.clone_from(&self.lost_because);
                tracing::error!(device, port = self.status.port, seen, "link lost");
            }
            InstrumentEvent::Restarted { at_s } => {
                self.lost_because = Some("the instrument started anew".to_owned());
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
            InstrumentEvent::Overflow { .. } => {}
        }
        0
    }

    /// The device as it is now.
    pub(super) fn status(&self) -> DeviceStatus {
        let channel = |channel: &AttachedChannel| ChannelStatus {
            quantity: channel.quantity,
            unit: channel.quantity.unit(),
            value: channel.last.map(|last| last.sample.value),
            time_s: channel.last.map(|last| last.sample.time_s),
            quality: channel.last.map_or(Quality::GOOD, |last| last.quality).names().collect(),
            bound_s: channel.last.map(|last| last.bound_s),
            recent: channel.recent(),
            counts: channel.counts,
        };
        DeviceStatus {
            channels: self.channels.iter().map(channel).collect(),
            ..self.status.clone()
        }
    }
}
