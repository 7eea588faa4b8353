//! Reads a part file once to learn what a conversion has to know before it begins.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

use mcap::parse_record;
use mcap::records::Record as McapRecord;

use super::closed::{Exit, STOP_METADATA, Stop};
use super::part_reader::{PartReader, Spoilt};
use crate::documents::{DOCUMENTS, RUN_START, RUN_STOP};
use crate::error::ReplayError;
use crate::record::{Record, RunStart};
use crate::topics::METADATA;

/// What a part file holds.
#[derive(Debug, Default)]
pub(crate) struct Survey {
    /// Metadata written at its start.
    pub(crate) provenance: BTreeMap<String, String>,
    /// How the recording ended, when its recorder came to say so.
    pub(crate) stop: Option<Stop>,
    /// Runs that began and did not end.
    pub(crate) open_runs: Vec<RunStart>,
    /// Messages that can be read.
    pub(crate) messages: u64,
    /// Messages whose channel was in a part of the file that is spoilt.
    pub(crate) unreadable: u64,
    /// Log time of the latest message [ns].
    pub(crate) last_log_time_ns: u64,
    pub(crate) spoilt: Spoilt,
}

impl Survey {
    /// Reads the part file from its beginning to its end.
    pub(crate) fn read(path: &Path, file: &File) -> Result<Self, ReplayError> {
        let mut reader = PartReader::new(path, file)?;
        let mut survey = Self::default();
        let mut topics = BTreeMap::new();
        while let Some((opcode, body)) = reader.next()? {
            match parse_record(opcode, body) {
                Ok(McapRecord::Channel(channel)) => {
                    topics.insert(channel.id, channel.topic);
                }
                Ok(McapRecord::Metadata(metadata)) => match metadata.name.as_str() {
                    METADATA => survey.provenance = metadata.metadata,
                    STOP_METADATA => survey.stop = Exit::from_entries(&metadata.metadata),
                    _ => {}
                },
                Ok(McapRecord::Message { header, data }) => {
                    let Some(topic) = topics.get(&header.channel_id) else {
                        survey.unreadable += 1;
                        continue;
                    };
                    survey.messages += 1;
                    survey.last_log_time_ns = header.log_time.max(survey.last_log_time_ns);
                    survey.follow_run(topic, &data);
                }
                Ok(_) => {}
                Err(error) => return Err(reader.damaged(error)),
            }
        }
        survey.spoilt = reader.spoilt();
        Ok(survey)
    }

    /// Log time [ns] at which the recording's own time base reads zero.
    pub(crate) fn zero_log_time_ns(&self) -> u64 {
        let told = self.provenance.get("zero_log_time_ns");
        told.and_then(|text| text.parse().ok()).unwrap_or(0)
    }

    /// Whether nothing was recorded before its recorder ended.
    pub(crate) fn is_empty(&self) -> bool {
        // A first group may have been cut short; more than that would be worth a look.
        const FIRST_GROUP_BYTES: u64 = 1 << 17;
        let Spoilt { torn_bytes, stretches, .. } = self.spoilt;
        self.messages + self.unreadable + stretches == 0 && torn_bytes <= FIRST_GROUP_BYTES
    }

    fn follow_run(&mut self, topic: &str, message: &[u8]) {
        let (start, stop) = (&DOCUMENTS[RUN_START], &DOCUMENTS[RUN_STOP]);
        if topic == start.topic {
            if let Ok(Record::RunStart(run)) = start.decode(message) {
                self.open_runs.push(run);
            }
        } else if topic == stop.topic
            && let Ok(Record::RunStop(stop)) = stop.decode(message)
        {
            self.open_runs.retain(|open| open.run != stop.run);
        }
    }
}
