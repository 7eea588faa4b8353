//! One of our own recordings as the records that were put into it, in their order.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use devices::{Quantity, Sample};
use mcap::parse_record;
use mcap::records::Record as McapRecord;
use serde_json::Value;

use crate::documents::{Document, document_of};
use crate::error::ReplayError;
use crate::mcap_records::Records;
use crate::record::Record;
use crate::topics::{METADATA, TIME_FIELD, TOPICS, Topic};

/// The records of one of our recordings, finished or still a part.
pub struct Recorded {
    path: PathBuf,
    records: Records,
    metadata: BTreeMap<String, String>,
    channels: BTreeMap<u16, Kind>,
    messages: u64,
    /// Whether samples are passed over undecoded.
    skips_samples: bool,
}

enum Kind {
    Sample(&'static Topic),
    Document(&'static Document),
    /// A topic that a later version knows.
    Unknown,
}

impl Recorded {
    /// Opens a recording at its beginning.
    ///
    /// # Errors
    /// [`ReplayError::Open`], [`ReplayError::NotMcap`], [`ReplayError::Damaged`].
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        let mut recorded = Self {
            path: path.to_owned(),
            records: Records::open(path)?,
            metadata: BTreeMap::new(),
            channels: BTreeMap::new(),
            messages: 0,
            skips_samples: false,
        };
        // Our metadata stands before the first message.
        let mut ahead = Records::open(path)?;
        while let Some(opcode) = ahead.next()? {
            match parse_record(opcode, ahead.body()) {
                Ok(McapRecord::Metadata(metadata)) if metadata.name == METADATA => {
                    recorded.metadata = metadata.metadata;
                    break;
                }
                Ok(McapRecord::Message { .. }) => break,
                Ok(_) => {}
                Err(error) => return Err(ahead.damaged(error)),
            }
        }
        Ok(recorded)
    }

    /// What the recording says about itself: `campaign`, `source`, `zero_log_time_ns`, and when it
    /// is finished `exit_status`, `reason` and the numbers of what was lost.
    pub fn metadata(&self) -> &BTreeMap<String, String> {
        &self.metadata
    }

    /// The same without its samples, for who decodes them anew from the raw bytes.
    pub(crate) fn without_samples(self) -> Self {
        Self { skips_samples: true, ..self }
    }

    /// Bytes read so far and bytes of the file.
    pub(crate) fn progress(&self) -> (u64, u64) {
        (self.records.bytes_read(), self.records.bytes_total())
    }

    /// Byte at which the file was torn, when it was and reading came that far.
    pub(crate) fn torn_at(&self) -> Option<u64> {
        self.records.torn_at()
    }

    /// The next record; none at the end of the file or its tear.
    ///
    /// # Errors
    /// [`ReplayError::Read`], [`ReplayError::Damaged`], [`ReplayError::Field`] when a message is
    /// not what its topic promises.
    pub fn next_record(&mut self) -> Result<Option<Record>, ReplayError> {
        while let Some(opcode) = self.records.next()? {
            match parse_record(opcode, self.records.body()) {
                Ok(McapRecord::Channel(channel)) => {
                    let sampled = TOPICS.iter().find(|topic| topic.name == channel.topic);
                    let kind = match (sampled, document_of(&channel.topic)) {
                        (Some(topic), _) => Kind::Sample(topic),
                        (None, Some(document)) => Kind::Document(document),
                        (None, None) => Kind::Unknown,
                    };
                    self.channels.insert(channel.id, kind);
                }
                Ok(McapRecord::Message { header, data }) => {
                    self.messages += 1;
                    let decoded = match self.channels.get(&header.channel_id) {
                        Some(Kind::Sample(_)) if self.skips_samples => continue,
                        Some(Kind::Sample(topic)) => sample(topic, &data),
                        Some(Kind::Document(document)) => {
                            document.decode(&data).map_err(|error| error.to_string())
                        }
                        Some(Kind::Unknown) | None => continue,
                    };
                    return decoded.map(Some).map_err(|found| self.wrong(header.channel_id, found));
                }
                Ok(_) => {}
                Err(error) => return Err(self.records.damaged(error)),
            }
        }
        Ok(None)
    }

    fn wrong(&self, channel: u16, found: String) -> ReplayError {
        let (topic, field) = match self.channels.get(&channel) {
            Some(Kind::Sample(topic)) => (topic.name, topic.field),
            Some(Kind::Document(document)) => (document.topic, ""),
            Some(Kind::Unknown) | None => ("", ""),
        };
        ReplayError::Field {
            path: self.path.clone(),
            topic: topic.to_owned(),
            message: self.messages,
            field: field.to_owned(),
            found,
        }
    }
}

/// The sample of a message.
fn sample(topic: &Topic, message: &[u8]) -> Result<Record, String> {
    let object: Value = serde_json::from_slice(message).map_err(|error| error.to_string())?;
    let number = |field: &str| {
        object.get(field).and_then(Value::as_f64).ok_or_else(|| format!("without \"{field}\""))
    };
    let quantity: Quantity = topic.quantity;
    let (time_s, value) = (number(TIME_FIELD)?, number(topic.field)?);
    Ok(Record::Sample(Sample { quantity, time_s, value }))
}
