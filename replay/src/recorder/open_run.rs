//! Ends the runs that were open when a recording ended, with what was counted in them.

use std::collections::BTreeMap;

use devices::Quantity;

use super::closed::Exit;
use crate::documents::document_of;
use crate::record::{ChannelCounts, LossKind, Record, RunStart, RunStop};
use crate::topics::TOPICS;

/// A run that nobody ended.
pub(crate) struct OpenRun {
    start: RunStart,
    counts: BTreeMap<String, ChannelCounts>,
}

impl OpenRun {
    pub(crate) fn new(start: &RunStart) -> Self {
        Self { start: start.clone(), counts: BTreeMap::new() }
    }

    /// Counts a message of the recording, when it belongs to the run.
    pub(crate) fn count(&mut self, topic: &str, time_s: f64, message: &[u8]) {
        if time_s < self.start.start_s {
            return;
        }
        if let Some(sampled) = TOPICS.iter().find(|sampled| sampled.name == topic) {
            self.of(sampled.quantity.name()).samples += 1;
            return;
        }
        let document = document_of(topic).filter(|_| matches!(topic, "/gap" | "/loss"));
        match document.map(|document| document.decode(message)) {
            Some(Ok(Record::Gap(gap))) => {
                // A gap of a whole device is counted under the device's name.
                let name = if gap.channel.is_empty() { &gap.device } else { &gap.channel };
                self.of(name).lost += gap.lost.unwrap_or(0);
            }
            Some(Ok(Record::Loss(loss))) => {
                let counts = self.of(&loss.channel);
                match loss.kind {
                    LossKind::Lost => counts.lost += loss.count,
                    LossKind::Repeated => counts.repeated += loss.count,
                    LossKind::OverRange => counts.over_range += loss.count,
                    LossKind::Damaged => counts.damaged += loss.count,
                }
            }
            _ => {}
        }
    }

    /// The run's end, at the end of the recording.
    pub(crate) fn stop(self, end_s: f64, exit: &Exit) -> RunStop {
        let RunStart { run, start_s, .. } = self.start;
        let place = |counts: &ChannelCounts| {
            Quantity::ALL.iter().position(|quantity| quantity.name() == counts.channel)
        };
        let mut counts: Vec<ChannelCounts> = self.counts.into_values().collect();
        counts.sort_by_key(|counts| place(counts).unwrap_or(usize::MAX));
        RunStop {
            time_s: end_s,
            run,
            start_s,
            end_s,
            exit_status: exit.status,
            reason: format!("the recording ended: {}", exit.reason),
            counts,
        }
    }

    fn of(&mut self, channel: &str) -> &mut ChannelCounts {
        self.counts.entry(channel.to_owned()).or_insert_with(|| ChannelCounts {
            channel: channel.to_owned(),
            ..ChannelCounts::default()
        })
    }
}
