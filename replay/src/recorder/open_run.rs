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
    /// As samples carry their times, rounded to whole nanoseconds.
    start_log_time_ns: i128,
    counts: BTreeMap<String, ChannelCounts>,
}

impl OpenRun {
    /// A run of a recording whose time base reads zero at a log time.
    pub(crate) fn new(start: &RunStart, zero_log_time_ns: u64) -> Self {
        let from_zero_ns = (start.start_s * 1e9).round() as i128;
        let start_log_time_ns = from_zero_ns + i128::from(zero_log_time_ns);
        Self { start: start.clone(), start_log_time_ns, counts: BTreeMap::new() }
    }

    /// Counts a message of the recording, when it belongs to the run.
    pub(crate) fn count(&mut self, topic: &str, log_time_ns: u64, message: &[u8]) {
        if i128::from(log_time_ns) < self.start_log_time_ns {
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
