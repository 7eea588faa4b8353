//! What a file holds, as counts and one checksum, to compare what was written with what is read.

use std::collections::BTreeMap;
use std::path::Path;

use mcap::parse_record;
use mcap::records::{MessageHeader, Record};

use crate::error::ReplayError;
use crate::mcap_records::Records;

/// Messages of each topic, and a checksum over all in their order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Contents {
    pub(crate) topics: BTreeMap<String, u64>,
    pub(crate) checksum: u32,
}

/// Contents while they are gathered.
#[derive(Default)]
pub(crate) struct Digest {
    channels: BTreeMap<u16, Channel>,
    hasher: crc32fast::Hasher,
}

struct Channel {
    topic: String,
    topic_checksum: u32,
    messages: u64,
}

impl Digest {
    /// Takes a channel; its messages follow.
    pub(crate) fn channel(&mut self, id: u16, topic: &str) {
        self.channels.entry(id).or_insert_with(|| Channel {
            topic: topic.to_owned(),
            topic_checksum: crc32fast::hash(topic.as_bytes()),
            messages: 0,
        });
    }

    /// Takes a message, unless its channel is unknown.
    pub(crate) fn message(&mut self, header: &MessageHeader, data: &[u8]) -> bool {
        let Some(channel) = self.channels.get_mut(&header.channel_id) else { return false };
        channel.messages += 1;
        let mut bytes = [0; 16];
        bytes[..4].copy_from_slice(&channel.topic_checksum.to_le_bytes());
        bytes[4..8].copy_from_slice(&header.sequence.to_le_bytes());
        bytes[8..].copy_from_slice(&header.log_time.to_le_bytes());
        self.hasher.update(&bytes);
        self.hasher.update(data);
        true
    }

    /// What was taken.
    pub(crate) fn contents(self) -> Contents {
        let mut topics = BTreeMap::new();
        for channel in self.channels.into_values().filter(|channel| channel.messages > 0) {
            *topics.entry(channel.topic).or_insert(0) += channel.messages;
        }
        Contents { topics, checksum: self.hasher.finalize() }
    }
}

impl Contents {
    /// Reads a finished file from its first byte to its last.
    ///
    /// # Errors
    /// [`ReplayError::NotKept`] when the file is torn or its own statistics tell otherwise,
    /// [`ReplayError::Damaged`] when a chunk's checksum is wrong.
    pub(crate) fn read(path: &Path) -> Result<Self, ReplayError> {
        let not_kept = |fault: String| ReplayError::NotKept { path: path.to_owned(), fault };
        let mut records = Records::open(path)?;
        let (mut digest, mut messages, mut told) = (Digest::default(), 0, None);
        while let Some(opcode) = records.next()? {
            match parse_record(opcode, records.body()) {
                Ok(Record::Channel(channel)) => digest.channel(channel.id, &channel.topic),
                Ok(Record::Message { header, data }) if digest.message(&header, &data) => {
                    messages += 1;
                }
                Ok(Record::Message { header, .. }) => {
                    return Err(not_kept(format!("channel {} is unknown", header.channel_id)));
                }
                Ok(Record::Statistics(statistics)) => told = Some(statistics.message_count),
                Ok(_) => {}
                Err(error) => return Err(records.damaged(error)),
            }
        }
        if let Some(offset) = records.torn_at() {
            return Err(not_kept(format!("it is torn at byte {offset}")));
        }
        if told != Some(messages) {
            return Err(not_kept(format!("its statistics tell {told:?} messages of {messages}")));
        }
        Ok(digest.contents())
    }
}
