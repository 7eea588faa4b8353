//! What an MCAP file holds: its topics, its first log time, and whether we wrote it.

use std::collections::BTreeMap;
use std::path::Path;

use mcap::parse_record;
use mcap::records::{Record, op};

use crate::error::ReplayError;
use crate::mcap_records::Records;
use crate::topics::{METADATA, PROFILE};

/// What an MCAP file holds.
#[derive(Debug, Default)]
pub(crate) struct Inventory {
    /// Whether the file is one of our own recordings.
    pub(crate) ours: bool,
    /// What such a recording says about itself.
    pub(crate) metadata: BTreeMap<String, String>,
    /// Message encoding of each topic that has messages.
    pub(crate) encodings: BTreeMap<String, String>,
    /// Log time of the earliest message [ns].
    pub(crate) first_log_time_ns: Option<u64>,
}

impl Inventory {
    /// Reads the summary of the file, or all of it when it was torn or has no summary.
    pub(crate) fn read(path: &Path) -> Result<Self, ReplayError> {
        let (ours, metadata) = introduction(&mut Records::open(path)?)?;
        let mut records = Records::open(path)?;
        // A damaged summary is no loss as long as the messages can be read.
        if records.seek_to_summary()?
            && let Ok(Some(inventory)) = Self::from_summary(&mut records)
        {
            return Ok(Self { ours, metadata, ..inventory });
        }
        let inventory = Self::from_messages(&mut Records::open(path)?)?;
        Ok(Self { ours, metadata, ..inventory })
    }

    /// The topics' names.
    pub(crate) fn topics(&self) -> Vec<String> {
        self.encodings.keys().cloned().collect()
    }

    /// Reads channels and statistics; none when the summary lacks either.
    fn from_summary(records: &mut Records) -> Result<Option<Self>, ReplayError> {
        let mut channels = BTreeMap::new();
        let mut statistics = None;
        while let Some(opcode) = records.next()? {
            if !matches!(opcode, op::CHANNEL | op::STATISTICS) {
                continue;
            }
            match parse_record(opcode, records.body()) {
                Ok(Record::Channel(channel)) => drop(channels.insert(channel.id, channel)),
                Ok(Record::Statistics(found)) => statistics = Some(found),
                Ok(_) => {}
                Err(error) => return Err(records.damaged(error)),
            }
        }
        let Some(statistics) = statistics else { return Ok(None) };
        let mut inventory = Self::default();
        for (id, messages) in &statistics.channel_message_counts {
            let Some(channel) = channels.get(id) else { return Ok(None) };
            if *messages > 0 {
                let (topic, encoding) = (channel.topic.clone(), channel.message_encoding.clone());
                inventory.encodings.insert(topic, encoding);
            }
        }
        if statistics.message_count > 0 {
            inventory.first_log_time_ns = Some(statistics.message_start_time);
        }
        // Counts for each channel may be left out of the statistics.
        Ok(Some(inventory).filter(|found| !found.encodings.is_empty()))
    }

    /// Reads every message's header up to the end or the tear.
    fn from_messages(records: &mut Records) -> Result<Self, ReplayError> {
        let mut inventory = Self::default();
        let mut channels = BTreeMap::new();
        while let Some(opcode) = records.next()? {
            if !matches!(opcode, op::CHANNEL | op::MESSAGE) {
                continue;
            }
            let (id, log_time_ns) = match parse_record(opcode, records.body()) {
                Ok(Record::Channel(channel)) => {
                    channels.insert(channel.id, channel);
                    continue;
                }
                Ok(Record::Message { header, .. }) => (header.channel_id, header.log_time),
                Ok(_) => continue,
                Err(error) => return Err(records.damaged(error)),
            };
            let first = inventory.first_log_time_ns.get_or_insert(log_time_ns);
            *first = log_time_ns.min(*first);
            if let Some(channel) = channels.remove(&id) {
                inventory.encodings.insert(channel.topic, channel.message_encoding);
            }
        }
        Ok(inventory)
    }
}

/// Whether the header carries our profile, and the metadata behind it.
fn introduction(records: &mut Records) -> Result<(bool, BTreeMap<String, String>), ReplayError> {
    let mut ours = false;
    while let Some(opcode @ (op::HEADER | op::METADATA)) = records.next()? {
        match parse_record(opcode, records.body()) {
            Ok(Record::Header(header)) if header.profile == PROFILE => ours = true,
            Ok(Record::Metadata(found)) if ours && found.name == METADATA => {
                return Ok((ours, found.metadata));
            }
            Ok(_) => break,
            Err(error) => return Err(records.damaged(error)),
        }
    }
    Ok((ours, BTreeMap::new()))
}
