//! Asks one instrument who it is and what it reads: `rolltank devices` and `rolltank check`.

use std::sync::Arc;
use std::time::Duration;

use crate::channel::Counts;
use crate::clock::{Clock, NS_PER_S};
use crate::driver::{Decoded, FieldValue};
use crate::error::InstrumentError;
use crate::instrument::Instrument;
use crate::interpreter::{InstrumentEvent, Measured};
use crate::port::LinkEvent;
use crate::setup::DeviceConfig;
use crate::{Quality, Quantity};

/// What an instrument brought while it was listened to.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbeReport {
    /// Whether its port could be opened.
    pub linked: bool,
    /// Whether its driver has a way to ask it who it is.
    pub asks_who: bool,
    /// What it says it is, where it can.
    pub identity: Option<String>,
    /// Each channel's last sample, rate and counts.
    pub channels: Vec<ChannelReport>,
    /// Each of its fields as it says them, whether a channel takes it or not.
    pub fields: Vec<FieldReport>,
    /// What a person must mend.
    pub troubles: Vec<InstrumentError>,
}

/// One channel of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelReport {
    /// What it measures.
    pub quantity: Quantity,
    /// Its last sample.
    pub last: Option<Measured>,
    /// Samples a second, from two of them on.
    pub rate_hz: Option<f64>,
    /// Every flag that any of its samples carried.
    pub quality: Quality,
    /// What was received, lost, repeated, over range, damaged.
    pub counts: Counts,
}

/// One field of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldReport {
    /// The field as its driver names it.
    pub name: String,
    /// Its last value in the instrument's own unit.
    pub last_raw: Option<f64>,
    /// Values a second, from two of them on.
    pub rate_hz: Option<f64>,
    n_values: u64,
    first_ns: u64,
}

/// Listens to an instrument for `duration_ns`, or until it has trouble that ends all hope of more.
///
/// # Errors
/// [`InstrumentError`] when its settings are wrong.
pub fn probe(
    config: &DeviceConfig,
    duration_ns: u64,
    clock: &Arc<dyn Clock>,
) -> Result<ProbeReport, InstrumentError> {
    let mut instrument = Instrument::start(config, Arc::clone(clock))?;
    let protocol = config.protocol()?;
    let mut report = ProbeReport {
        linked: false,
        asks_who: protocol.asks_who(),
        identity: None,
        channels: Vec::new(),
        fields: protocol.fields().into_iter().map(FieldReport::of).collect(),
        troubles: Vec::new(),
    };
    let mut heard: Vec<(Quantity, Heard)> =
        config.channels.iter().map(|channel| (channel.quantity, Heard::default())).collect();
    let until_ns = clock.now_ns().saturating_add(duration_ns);
    let mut events = Vec::new();
    while clock.now_ns() < until_ns {
        let link = instrument.next(Duration::from_millis(20), &mut events);
        if let Some(LinkEvent::Received { at_ns, decoded, .. }) = &link {
            report.take_fields(decoded, *at_ns);
        }
        for event in events.drain(..) {
            match event {
                InstrumentEvent::Linked { .. } => report.linked = true,
                InstrumentEvent::Identity(text) => report.identity = Some(text),
                InstrumentEvent::Trouble(trouble) => report.troubles.push(trouble),
                InstrumentEvent::Sample(measured) => {
                    let of = measured.sample.quantity;
                    let heard = heard.iter_mut().filter(|(quantity, _)| *quantity == of);
                    heard.for_each(|(_, heard)| heard.push(measured));
                }
                _ => {}
            }
        }
        // A port that cannot be opened brings nothing however long one waits.
        if !report.linked && !report.troubles.is_empty() {
            break;
        }
    }
    let counts = instrument.counts();
    report.channels = heard
        .into_iter()
        .zip(counts)
        .map(|((quantity, heard), (_, counts))| heard.report(quantity, counts))
        .collect();
    Ok(report)
}

impl ProbeReport {
    fn take_fields(&mut self, decoded: &[Decoded], at_ns: u64) {
        let values = decoded.iter().filter_map(|what| match what {
            Decoded::Values { values, .. } => Some(values),
            _ => None,
        });
        for FieldValue { field, raw, .. } in values.flatten() {
            if let Some(report) = self.fields.get_mut(*field) {
                report.push(*raw, at_ns);
            }
        }
    }
}

impl FieldReport {
    fn of(name: String) -> Self {
        Self { name, last_raw: None, rate_hz: None, n_values: 0, first_ns: 0 }
    }

    fn push(&mut self, raw: f64, at_ns: u64) {
        if self.n_values == 0 {
            self.first_ns = at_ns;
        }
        let span_s = at_ns.saturating_sub(self.first_ns) as f64 / NS_PER_S;
        self.rate_hz = (span_s > 0.0).then(|| self.n_values as f64 / span_s);
        self.last_raw = Some(raw);
        self.n_values += 1;
    }
}

#[derive(Default)]
struct Heard {
    first_s: Option<f64>,
    last: Option<Measured>,
    n_samples: u64,
    quality: Quality,
}

impl Heard {
    fn push(&mut self, measured: Measured) {
        self.first_s.get_or_insert(measured.sample.time_s);
        self.last = Some(measured);
        self.n_samples += 1;
        self.quality = self.quality.with(measured.quality);
    }

    fn report(self, quantity: Quantity, counts: Counts) -> ChannelReport {
        let span_s =
            self.last.zip(self.first_s).map(|(last, first_s)| last.sample.time_s - first_s);
        let rate_hz = span_s
            .filter(|span_s| *span_s > 0.0)
            .map(|span_s| self.n_samples.saturating_sub(1) as f64 / span_s);
        ChannelReport { quantity, last: self.last, rate_hz, quality: self.quality, counts }
    }
}
