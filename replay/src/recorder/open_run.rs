//! Ends the runs that were open when a recording ended, with what was counted in them.

use std::collections::BTreeMap;

use devices::Quantity;

use super::closed::Exit;
use crate::documents::document_of;
use crate::record::{ChannelCounts, LossKind, Record, RunStart, RunStop};
use crate::topics::TOPICS;

/// The runs that nobody ended, in the order of their starts.
pub(crate) struct OpenRuns {
    runs: Vec<Open>,
}

struct Open {
    start: RunStart,
    /// As samples carry their times, rounded to whole nanoseconds.
    start_log_time_ns: i128,
    /// What came from its start on and before the next run's; so each message is counted once,
    /// however many runs are open.
    counts: Counts,
}

type Counts = BTreeMap<String, ChannelCounts>;

impl OpenRuns {
    /// Runs of a recording whose time base reads zero at a log time.
    pub(crate) fn new(starts: &[RunStart], zero_log_time_ns: u64) -> Self {
        let open = |start: &RunStart| {
            let from_zero_ns = (start.start_s * 1e9).round() as i128;
            let start_log_time_ns = from_zero_ns + i128::from(zero_log_time_ns);
            Open { start: start.clone(), start_log_time_ns, counts: Counts::new() }
        };
        let mut runs: Vec<Open> = starts.iter().map(open).collect();
        runs.sort_by_key(|run| run.start_log_time_ns);
        Self { runs }
    }

    /// Counts a message of the recording, when it belongs to a run.
    pub(crate) fn count(&mut self, topic: &str, log_time_ns: u64, message: &[u8]) {
        let is_after = |run: &Open| run.start_log_time_ns <= i128::from(log_time_ns);
        let started = self.runs.partition_point(is_after);
        let Some(Open { counts, .. }) = started.checked_sub(1).map(|last| &mut self.runs[last])
        else {
            return;
        };
        if let Some(sampled) = TOPICS.iter().find(|sampled| sampled.name == topic) {
            of(counts, sampled.quantity.name()).samples += 1;
            return;
        }
        let document = document_of(topic).filter(|_| matches!(topic, "/gap" | "/loss"));
        match document.map(|document| document.decode(message)) {
            Some(Ok(Record::Gap(gap))) => {
                // A gap of a whole device is counted under the device's name.
                let name = if gap.channel.is_empty() { &gap.device } else { &gap.channel };
                of(counts, name).lost += gap.lost.unwrap_or(0);
            }
            Some(Ok(Record::Loss(loss))) => {
                let counts = of(counts, &loss.channel);
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

    /// The runs' ends, at the end of the recording.
    pub(crate) fn stops(self, end_s: f64, exit: &Exit) -> Vec<RunStop> {
        let mut since = Counts::new();
        let mut stops = Vec::new();
        // What came after a run's start came after every earlier run's too.
        for Open { start, counts, .. } in self.runs.into_iter().rev() {
            for more in counts.into_values() {
                let total = of(&mut since, &more.channel);
                total.samples += more.samples;
                total.lost += more.lost;
                total.repeated += more.repeated;
                total.over_range += more.over_range;
                total.damaged += more.damaged;
            }
            stops.push(stop(start, since.values().cloned().collect(), end_s, exit));
        }
        stops.reverse();
        stops
    }
}

fn stop(start: RunStart, mut counts: Vec<ChannelCounts>, end_s: f64, exit: &Exit) -> RunStop {
    let place = |counts: &ChannelCounts| {
        Quantity::ALL.iter().position(|quantity| quantity.name() == counts.channel)
    };
    counts.sort_by_key(|counts| place(counts).unwrap_or(usize::MAX));
    RunStop {
        time_s: end_s,
        run: start.run,
        start_s: start.start_s,
        end_s,
        exit_status: exit.status,
        reason: format!("the recording ended: {}", exit.reason),
        counts,
    }
}

fn of<'c>(counts: &'c mut Counts, channel: &str) -> &'c mut ChannelCounts {
    counts.entry(channel.to_owned()).or_insert_with(|| ChannelCounts {
        channel: channel.to_owned(),
        ..ChannelCounts::default()
    })
}
