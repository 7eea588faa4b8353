//! Which channel of a part file each record goes to, and where it stands there.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use mcap::records::MessageHeader;

use super::Provenance;
use super::part_bytes::{channel, message, metadata, schema};
use crate::documents::{DOCUMENTS, RAW, RAW_PREFIX, write_document};
use crate::record::Record;
use crate::topics::{METADATA, TOPICS};

/// Channels of a part file: the samples', then the documents', then one for each device's bytes.
const FIRST_SAMPLE_ID: u16 = 1;
const FIRST_DOCUMENT_ID: u16 = FIRST_SAMPLE_ID + TOPICS.len() as u16;
const FIRST_RAW_ID: u16 = 256;

/// The channels of one part file with what was written to each.
pub(crate) struct Layout {
    samples: [SampleChannel; TOPICS.len()],
    documents: [u32; DOCUMENTS.len()],
    raw: HashMap<Arc<str>, RawChannel>,
    message: Vec<u8>,
}

#[derive(Clone, Copy)]
struct SampleChannel {
    messages: u32,
    last_s: f64,
}

struct RawChannel {
    id: u16,
    messages: u32,
}

/// A sample whose time is before that of the one before it.
pub(crate) struct Backwards {
    pub(crate) previous_s: f64,
}

impl Layout {
    pub(crate) fn new() -> Self {
        Self {
            samples: [SampleChannel { messages: 0, last_s: f64::NEG_INFINITY }; TOPICS.len()],
            documents: [0; DOCUMENTS.len()],
            raw: HashMap::new(),
            message: Vec::new(),
        }
    }

    /// Appends a record to a group.
    pub(crate) fn append(
        &mut self,
        group: &mut Vec<u8>,
        record: &Record,
        log_time: u64,
    ) -> Result<(), Backwards> {
        let (channel_id, messages) = match record {
            Record::Sample(sample) => {
                let slot = sample.quantity as usize;
                let channel = &mut self.samples[slot];
                if sample.time_s < channel.last_s {
                    return Err(Backwards { previous_s: channel.last_s });
                }
                channel.last_s = sample.time_s;
                TOPICS[slot].write_message(sample, &mut self.message);
                (FIRST_SAMPLE_ID + slot as u16, &mut channel.messages)
            }
            Record::Raw(raw) => {
                let id = FIRST_RAW_ID + self.raw.len() as u16;
                let known = self.raw.entry(raw.device.clone()).or_insert_with(|| {
                    // The channel comes into the file with its first message.
                    let topic = format!("{RAW_PREFIX}{}", raw.device);
                    channel(group, id, FIRST_DOCUMENT_ID + RAW as u16, &topic);
                    RawChannel { id, messages: 0 }
                });
                write_document(record, &mut self.message);
                (known.id, &mut known.messages)
            }
            _ => {
                let kind = write_document(record, &mut self.message);
                let kind = kind.expect("every record but a sample is a document");
                (FIRST_DOCUMENT_ID + kind as u16, &mut self.documents[kind])
            }
        };
        let sequence = *messages;
        *messages = messages.wrapping_add(1);
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        message(group, &header, &self.message);
        Ok(())
    }
}

/// Writes what every part begins with: where it comes from, and every topic but the raw bytes'.
///
/// All of it is on the disk before the first record is taken, so that no later damage can make the
/// records unreadable.
pub(crate) fn declare(group: &mut Vec<u8>, provenance: &Provenance) {
    let Provenance { campaign_text, source, zero_log_time_ns } = provenance;
    let entries = [
        ("campaign", campaign_text.clone()),
        ("source", source.clone()),
        ("zero_log_time_ns", zero_log_time_ns.to_string()),
    ];
    let entries: BTreeMap<_, _> =
        entries.into_iter().map(|(key, text)| (key.to_owned(), text)).collect();
    metadata(group, METADATA, &entries);
    for (id, topic) in (FIRST_SAMPLE_ID..).zip(&TOPICS) {
        schema(group, id, &topic.schema_name(), &topic.schema());
        channel(group, id, id, topic.name);
    }
    for (id, (kind, document)) in (FIRST_DOCUMENT_ID..).zip(DOCUMENTS.iter().enumerate()) {
        schema(group, id, &document.schema_name(), &document.schema());
        if kind != RAW {
            channel(group, id, id, document.topic);
        }
    }
}
