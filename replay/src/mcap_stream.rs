//! One topic of an MCAP file as a stream of samples in time order.

use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};

use devices::{Quantity, Sample};
use mcap::parse_record;
use mcap::records::{Record, op};

use crate::error::ReplayError;
use crate::mcap_records::Records;
use crate::message::{Format, Found};
use crate::note::{Note, Tally, counted};
use crate::stamps::{StampFault, Stamped, Stamps, WAITING_MAX};
use crate::stream::Stream;

/// Messages of the topic held back to put them in order of time.
pub(crate) const REORDERED_MESSAGES: usize = 4096;

/// Where one channel stands in an MCAP file.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    pub(crate) quantity: Quantity,
    pub(crate) topic: String,
    /// Path of the value's field.
    pub(crate) field: String,
    pub(crate) si_per_unit: f64,
    pub(crate) time: MessageTime,
}

/// How messages get their times.
#[derive(Debug, Clone)]
pub(crate) enum MessageTime {
    /// From the log time, counted from the recording's first [ns].
    LogTime { first_ns: u64 },
    /// From a field of the message.
    Field { path: String, seconds_per_unit: f64 },
}

/// One topic of one file.
pub(crate) struct McapStream {
    path: PathBuf,
    records: Records,
    place: Place,
    /// Name and definition of the schemas seen.
    schemas: BTreeMap<u16, (String, Vec<u8>)>,
    /// The topic's channels, of which it may have several.
    channels: BTreeMap<u16, Format>,
    /// Messages in order of time, equals in order of the file.
    window: VecDeque<Waiting>,
    stamps: Stamps<f64>,
    messages: u64,
    ended: bool,
    /// Why reading stopped, told after what was read before it.
    failure: Option<ReplayError>,
    latest_s: f64,
    disordered: Tally,
    repeated: Tally,
    null: Tally,
}

/// A message in the window.
struct Waiting {
    time_s: f64,
    message: u64,
    value: f64,
}

impl McapStream {
    /// Opens the file for one of its topics.
    pub(crate) fn open(path: &Path, place: Place) -> Result<Self, ReplayError> {
        Ok(Self {
            path: path.to_owned(),
            records: Records::open(path)?,
            place,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            window: VecDeque::new(),
            stamps: Stamps::new(),
            messages: 0,
            ended: false,
            failure: None,
            latest_s: f64::NEG_INFINITY,
            disordered: Tally::default(),
            repeated: Tally::default(),
            null: Tally::default(),
        })
    }

    /// Reads until one more message of the topic is in the window, or the file ends.
    fn read_message(&mut self) -> Result<(), ReplayError> {
        while let Some(opcode) = self.records.next()? {
            if !matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
                continue;
            }
            if opcode == op::MESSAGE && !self.is_ours(self.records.body()) {
                continue;
            }
            match parse_record(opcode, self.records.body()) {
                Ok(Record::Schema { header, data }) => {
                    self.schemas.insert(header.id, (header.name, data.into_owned()));
                }
                Ok(Record::Channel(channel)) => {
                    if channel.topic == self.place.topic {
                        self.add_channel(&channel)?;
                    }
                }
                Ok(Record::Message { header, data }) => {
                    if let Some(format) = self.channels.get(&header.channel_id) {
                        self.messages += 1;
                        let read = self.sample(header.log_time, format, &data)?;
                        if let Some((time_s, value)) = read {
                            self.hold_back(time_s, value);
                            return Ok(());
                        }
                        self.null.add(|| self.messages);
                    }
                }
                Ok(_) => {}
                Err(error) => return Err(self.records.damaged(error)),
            }
        }
        self.ended = true;
        Ok(())
    }

    /// Whether a message may be of the topic, by the channel that it starts with: most are not.
    fn is_ours(&self, message: &[u8]) -> bool {
        let Some(channel) = message.first_chunk() else { return true };
        self.channels.contains_key(&u16::from_le_bytes(*channel))
    }

    fn add_channel(&mut self, channel: &mcap::records::Channel) -> Result<(), ReplayError> {
        // A summary repeats its channels; the first of them is the one the messages follow.
        if self.channels.contains_key(&channel.id) {
            return Ok(());
        }
        let schema = self.schemas.get(&channel.schema_id);
        let mut paths = vec![self.place.field.as_str()];
        if let MessageTime::Field { path, .. } = &self.place.time {
            paths.push(path);
        }
        let format = Format::new(&channel.message_encoding, schema, &paths).map_err(|fault| {
            let topic = self.place.topic.clone();
            ReplayError::Schema { path: self.path.clone(), topic, fault }
        })?;
        self.channels.insert(channel.id, format);
        Ok(())
    }

    /// Time [s] and value of a message; none when a field is null.
    fn sample(
        &self,
        log_time_ns: u64,
        format: &Format,
        message: &[u8],
    ) -> Result<Option<(f64, f64)>, ReplayError> {
        let time_s = match &self.place.time {
            MessageTime::LogTime { first_ns } => {
                Some((i128::from(log_time_ns) - i128::from(*first_ns)) as f64 / 1e9)
            }
            MessageTime::Field { path, seconds_per_unit } => {
                self.number(format, message, path, *seconds_per_unit)?
            }
        };
        let value = self.number(format, message, &self.place.field, self.place.si_per_unit)?;
        Ok(time_s.zip(value))
    }

    fn number(
        &self,
        format: &Format,
        message: &[u8],
        field: &str,
        per_unit: f64,
    ) -> Result<Option<f64>, ReplayError> {
        let found = match format.number_at(message, field) {
            Ok(Found::Number(number)) if (number * per_unit).is_finite() => {
                return Ok(Some(number * per_unit));
            }
            Ok(Found::Null) => return Ok(None),
            Ok(Found::Number(number)) => format!("{number}, not a finite number in SI units"),
            Ok(Found::Absent) => "not there".to_owned(),
            Ok(Found::Other(what)) => format!("{what}, not a number"),
            Err(fault) => format!("unreadable, as the message is {fault}"),
        };
        Err(ReplayError::Field {
            path: self.path.clone(),
            topic: self.place.topic.clone(),
            message: self.messages,
            field: field.to_owned(),
            found,
        })
    }

    fn hold_back(&mut self, time_s: f64, value: f64) {
        if time_s < self.latest_s {
            self.disordered.add(|| self.messages);
        }
        self.latest_s = time_s.max(self.latest_s);
        // Nearly all belong at the end.
        let later = self.window.iter().rev().take_while(|w| w.time_s.total_cmp(&time_s).is_gt());
        let place = self.window.len() - later.count();
        self.window.insert(place, Waiting { time_s, message: self.messages, value });
    }

    fn release(&mut self, waiting: &Waiting) -> Result<(), ReplayError> {
        let Waiting { time_s, message, value } = *waiting;
        match self.stamps.push(Some(time_s), value) {
            Ok(Stamped::Repeated) => self.repeated.add(|| message),
            Ok(_) => {}
            Err(fault) => {
                let path = self.path.clone();
                let place = format!("topic \"{}\", message {message}", self.place.topic);
                return Err(match fault {
                    StampFault::Backwards { previous_s } => {
                        ReplayError::TimeBackwards { path, place, time_s, previous_s }
                    }
                    StampFault::TooManyWaiting => {
                        ReplayError::Unstamped { path, place, limit: WAITING_MAX }
                    }
                });
            }
        }
        Ok(())
    }
}

impl Stream for McapStream {
    fn next(&mut self) -> Result<Option<Sample>, ReplayError> {
        let quantity = self.place.quantity;
        loop {
            if let Some((time_s, value)) = self.stamps.pop() {
                return Ok(Some(Sample { quantity, time_s, value }));
            }
            while !self.ended && self.window.len() < REORDERED_MESSAGES {
                if let Err(error) = self.read_message() {
                    (self.ended, self.failure) = (true, Some(error));
                }
            }
            let Some(waiting) = self.window.pop_front() else {
                self.stamps.finish();
                return self.failure.take().map_or(Ok(None), Err);
            };
            self.release(&waiting)?;
        }
    }

    fn bytes_read(&self) -> u64 {
        self.records.bytes_read()
    }

    fn bytes_total(&self) -> u64 {
        self.records.bytes_total()
    }

    fn notes(&self, notes: &mut Vec<Note>) {
        let place = format!("\"{}\" topic \"{}\"", self.path.display(), self.place.topic);
        let told = [
            (&self.disordered, "out of order, sorted by time"),
            (&self.repeated, "repeating a time stamp, placed evenly between neighbours"),
            (&self.null, "without a value"),
        ];
        for (tally, what) in told.into_iter().filter(|(tally, _)| tally.count > 0) {
            let messages = tally.told("message", "number");
            notes.push(Note::mended(format!("{place}: {messages}, {what}")));
        }
        if self.stamps.left_out > 0 {
            notes.push(Note::lost(format!(
                "{place}: {} at the end left out, repeating the last time stamp",
                counted(self.stamps.left_out, "message")
            )));
        }
        if let Some(offset) = self.records.torn_at() {
            notes.push(Note::lost(format!(
                "{place}: the file is torn at byte {offset} of {}, {} before it read; \
                 hint: `mcap recover` makes it whole for other programs",
                self.records.bytes_total(),
                counted(self.messages, "message")
            )));
        }
    }
}
