//! From what happened on a link to samples in SI on the host's clock, gaps and troubles.
//!
//! A function of the events alone: replayed from a recording's raw bytes it gives the same, to the
//! bit.

use std::path::PathBuf;

use crate::channel::{Channel, Counted, Counts};
use crate::driver::{Decoded, FieldValue, Session, Taken};
use crate::error::InstrumentError;
use crate::port::LinkEvent;
use crate::setup::DeviceConfig;
use crate::stamp::{Stamp, StampSettings, Stamper};
use crate::trouble::Troubles;
use crate::{Quality, Quantity, Sample};

/// One sample with all that is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Quantity, host time and SI value.
    pub sample: Sample,
    /// The instrument's own number.
    pub raw: f64,
    /// What is wrong with it.
    pub quality: Quality,
    /// The time is at most so far off [s].
    pub bound_s: f64,
    /// Sequence number, where the instrument counts.
    pub sequence: Option<u64>,
}

/// What an instrument brings.
#[derive(Debug, Clone, PartialEq)]
pub enum InstrumentEvent {
    /// The link is up.
    Linked {
        /// When [ns].
        at_ns: u64,
    },
    /// The link is gone; what follows begins with a gap.
    LinkLost {
        /// When it was noticed [ns].
        at_ns: u64,
        /// What was seen.
        seen: String,
    },
    /// A sample.
    Sample(Measured),
    /// Samples are missing.
    Gap {
        /// The last sample before it [s].
        from_s: f64,
        /// The first sample after it [s].
        to_s: f64,
        /// How many are missing, where that is known.
        n_missing: Option<u64>,
    },
    /// The instrument restarted: its counters began anew.
    Restarted {
        /// The first sample after it [s].
        at_s: f64,
    },
    /// The instrument said who it is.
    Identity(String),
    /// Something is wrong that a person must mend; told once until it changes.
    Trouble(InstrumentError),
    /// The reader's queue was full.
    Overflow {
        /// Events that were dropped.
        n_events: u64,
    },
}

impl InstrumentEvent {
    /// The sample, where it is one whose value says something of its quantity.
    pub fn usable_sample(&self) -> Option<Sample> {
        match self {
            Self::Sample(measured) if measured.quality.is_usable() => Some(measured.sample),
            _ => None,
        }
    }
}

/// Interprets the events of one device.
pub struct Interpreter {
    device: String,
    port: PathBuf,
    channels: Vec<ChannelState>,
    quality: Quality,
    lag_is_declared: bool,
    stamper: Stamper,
    troubles: Troubles,
    gap_from_s: Option<f64>,
    last_time_s: Option<f64>,
}

struct ChannelState {
    channel: Channel,
    counts: Counts,
    last_time_s: f64,
    last_bound_s: f64,
}

/// Two samples of one channel are at least so far apart [s], whatever the clock's line does.
const STEP_MIN_S: f64 = 1e-6;

impl Interpreter {
    /// An interpreter for a device behind an adapter that holds bytes back for `latency_s`.
    ///
    /// # Errors
    /// [`InstrumentError::Settings`] when the driver does not open.
    pub fn new(config: &DeviceConfig, latency_s: f64) -> Result<Self, InstrumentError> {
        let protocol = config.protocol()?;
        let settings = StampSettings {
            ticks: protocol.device_clock(),
            sends_hz: config.pace.sends_hz,
            latency_s,
            age_s: config.pace.age_s,
            lag_s: config.lag.delay_s(),
            lag_bound_s: config.lag.bound_s(),
        };
        let state = |channel: &Channel| ChannelState {
            channel: channel.clone(),
            counts: Counts::default(),
            last_time_s: f64::NEG_INFINITY,
            last_bound_s: 0.0,
        };
        Ok(Self {
            device: config.name.clone(),
            port: config.port.clone(),
            channels: config.channels.iter().map(state).collect(),
            quality: Quality::GOOD.with_if(config.lag.is_flagged(), Quality::LAGGED),
            lag_is_declared: config.lag.is_declared(),
            stamper: Stamper::new(settings),
            troubles: Troubles::new(config, protocol.fields().len()),
            gap_from_s: None,
            last_time_s: None,
        })
    }

    /// Counts of each channel since the start.
    pub fn counts(&self) -> impl Iterator<Item = (Quantity, Counts)> {
        self.channels.iter().map(|state| (state.channel.quantity, state.counts))
    }

    /// The counts of each channel that has brought a sample, as they stand now.
    pub fn counted(&self) -> impl Iterator<Item = Counted> {
        let begun = self.channels.iter().filter(|state| state.last_time_s.is_finite());
        begun.map(|state| Counted {
            quantity: state.channel.quantity,
            time_s: state.last_time_s,
            bound_s: self.lag_is_declared.then_some(state.last_bound_s),
            counts: state.counts,
        })
    }

    /// Takes what happened, in its order, and appends what it means.
    pub fn interpret(&mut self, event: &LinkEvent, out: &mut Vec<InstrumentEvent>) {
        match event {
            LinkEvent::Opened { at_ns } => {
                self.stamper.reopened();
                self.troubles.opened(*at_ns);
                out.push(InstrumentEvent::Linked { at_ns: *at_ns });
            }
            // What was asked before is not missing.
            LinkEvent::Round { .. } => {}
            LinkEvent::Received { at_ns, bytes, decoded } => {
                self.troubles.received(bytes);
                self.decoded(decoded, *at_ns, out);
            }
            LinkEvent::Sent { at_ns, decoded, .. } | LinkEvent::Waited { at_ns, decoded } => {
                self.decoded(decoded, *at_ns, out);
            }
            LinkEvent::Silence { at_ns } => {
                self.troubles.silence();
                out.extend(self.troubles.take(*at_ns).into_iter().map(InstrumentEvent::Trouble));
            }
            LinkEvent::Lost { at_ns, seen } => {
                self.gap_from_s = self.gap_from_s.or(self.last_time_s);
                out.push(InstrumentEvent::LinkLost { at_ns: *at_ns, seen: seen.clone() });
            }
            LinkEvent::Absent { fault, present, .. } => {
                out.push(InstrumentEvent::Trouble(InstrumentError::Port {
                    device: self.device.clone(),
                    port: self.port.clone(),
                    fault: fault.clone(),
                    present: present.clone(),
                }));
            }
            LinkEvent::Overflow { n_events } => {
                // Which samples were in them is not known without a sequence number.
                self.gap_from_s = self.gap_from_s.or(self.last_time_s);
                out.push(InstrumentEvent::Overflow { n_events: *n_events });
            }
        }
    }

    /// Interprets a raw event of a recording, decoded anew by a fresh session.
    pub fn replay(
        &mut self,
        event: &LinkEvent,
        session: &mut Session,
        out: &mut Vec<InstrumentEvent>,
    ) {
        let event = match event {
            LinkEvent::Opened { at_ns } => {
                session.open(*at_ns);
                event.clone()
            }
            LinkEvent::Round { due_ns, .. } => {
                session.join(*due_ns);
                event.clone()
            }
            LinkEvent::Sent { at_ns, bytes, .. } => {
                let (mut sent, mut decoded) = (Vec::new(), Vec::new());
                session.poll(*at_ns, &mut sent, &mut decoded);
                LinkEvent::Sent { at_ns: *at_ns, bytes: bytes.clone(), decoded }
            }
            LinkEvent::Waited { at_ns, .. } => {
                let (mut sent, mut decoded) = (Vec::new(), Vec::new());
                session.poll(*at_ns, &mut sent, &mut decoded);
                LinkEvent::Waited { at_ns: *at_ns, decoded }
            }
            LinkEvent::Received { at_ns, bytes, .. } => {
                let mut decoded = Vec::new();
                session.receive(bytes, *at_ns, &mut decoded);
                LinkEvent::Received { at_ns: *at_ns, bytes: bytes.clone(), decoded }
            }
            other => other.clone(),
        };
        self.interpret(&event, out);
    }

    fn decoded(&mut self, decoded: &[Decoded], at_ns: u64, out: &mut Vec<InstrumentEvent>) {
        for what in decoded {
            match what {
                Decoded::Values { values, sequence, ticks, taken } => {
                    self.values(values, (*sequence, *ticks), *taken, out);
                }
                Decoded::Identity(text) => out.push(InstrumentEvent::Identity(text.clone())),
                Decoded::Silent { fields, .. } => {
                    self.count(
                        |channel| fields.contains(&channel.field),
                        |counts| counts.lost += 1,
                    );
                }
                Decoded::Missed { n_cycles } => {
                    self.count(|_| true, |counts| counts.lost += n_cycles);
                }
                Decoded::Damaged { .. } => self.count(|_| true, |counts| counts.damaged += 1),
                Decoded::Refused { .. } | Decoded::Unasked { .. } => {}
            }
            self.troubles.decoded(what, at_ns);
        }
        out.extend(self.troubles.take(at_ns).into_iter().map(InstrumentEvent::Trouble));
    }

    fn count(&mut self, of: impl Fn(&Channel) -> bool, add: impl Fn(&mut Counts)) {
        let states = self.channels.iter_mut().filter(|state| of(&state.channel));
        states.for_each(|state| add(&mut state.counts));
    }

    fn values(
        &mut self,
        values: &[FieldValue],
        (sequence, ticks): (Option<u64>, Option<u64>),
        taken: Taken,
        out: &mut Vec<InstrumentEvent>,
    ) {
        let stamp = self.stamper.stamp(sequence, ticks, taken);
        if stamp.repeated {
            return self.count(|_| true, |counts| counts.repeated += 1);
        }
        self.count(|_| true, |counts| counts.lost += stamp.n_missing);
        self.interruptions(&stamp, out);
        for value in values {
            let states = self.channels.iter_mut();
            for state in states.filter(|state| state.channel.field == value.field) {
                if value.quality.has(Quality::REPEATED) {
                    state.counts.repeated += 1;
                    continue;
                }
                out.push(InstrumentEvent::Sample(state.measure(value, &stamp, self.quality)));
            }
        }
        self.last_time_s = Some(stamp.time_s);
    }

    fn interruptions(&mut self, stamp: &Stamp, out: &mut Vec<InstrumentEvent>) {
        if stamp.restarted {
            out.push(InstrumentEvent::Restarted { at_s: stamp.time_s });
        }
        let counted = stamp.is_numbered && !stamp.restarted;
        let from_s = self.gap_from_s.take();
        if let (None, Some([from_s, to_s])) = (from_s, stamp.missing_between_s) {
            let n_missing = Some(stamp.n_missing);
            return out.push(InstrumentEvent::Gap { from_s, to_s, n_missing });
        }
        let gap = match (from_s, self.last_time_s) {
            // Without numbers nobody knows what was lost while the cable was out.
            (Some(from_s), _) => Some((from_s, counted.then_some(stamp.n_missing))),
            (None, Some(last_s)) if stamp.n_missing > 0 => Some((last_s, Some(stamp.n_missing))),
            (None, Some(last_s)) if stamp.restarted => Some((last_s, None)),
            _ => None,
        };
        if let Some((from_s, n_missing)) = gap {
            out.push(InstrumentEvent::Gap { from_s, to_s: stamp.time_s, n_missing });
        }
    }
}

impl ChannelState {
    fn measure(&mut self, reading: &FieldValue, stamp: &Stamp, quality: Quality) -> Measured {
        let (value, quality) = self.channel.value(reading.raw, reading.quality.with(quality));
        // The clock's line may move back a little; a channel's time does not.
        let time_s = stamp.time_s.max(self.last_time_s + STEP_MIN_S);
        (self.last_time_s, self.last_bound_s) = (time_s, stamp.bound_s);
        self.counts.received += 1;
        self.counts.over_range += u64::from(quality.has(Quality::OVER_RANGE));
        Measured {
            sample: Sample { quantity: self.channel.quantity, time_s, value },
            raw: reading.raw,
            quality,
            bound_s: stamp.bound_s,
            sequence: stamp.sequence,
        }
    }
}
