//! What the daemon is doing right now, for pages, gauges and whoever waits for it.

use std::net::SocketAddr;

use devices::Quantity;
use devices::channel::Counts;
use serde::{Deserialize, Serialize};

use super::motion::Motion;
use super::pass::Pass;
use crate::settling::Calm;

/// A copy of the daemon's state that is renewed a few times a second.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Status {
    /// Name of the campaign.
    pub campaign: String,
    /// Condition that is being recorded.
    pub condition: String,
    /// File that is being recorded to, as results name it.
    pub recording: String,
    /// Sessions begun: one more with every reload and every new recording.
    pub n_sessions: u64,
    /// The devices, in the order of the campaign file.
    pub devices: Vec<DeviceStatus>,
    /// Records taken, and bytes of the growing file.
    pub recorded: RecordedStatus,
    /// Runs and stretches so far, earlier recordings not counted.
    pub runs: RunsStatus,
    /// What the run under way says so far, in one line.
    pub provisional: Option<String>,
    /// Whether a new campaign file waits for the model to come to rest.
    pub reload_waits: bool,
    /// What was wrong with the campaign file that was last refused.
    pub refused_reload: Option<String>,
    /// Where the page is served, if anywhere.
    pub page: Option<SocketAddr>,
    /// Who stopped the recording, while it is.
    pub paused_by: Option<String>,
    /// What the model does.
    pub motion: Motion,
    /// How calm the water is, where it is known.
    pub calm: Option<Calm>,
    /// What the carriage does.
    pub pass: Pass,
    /// Length of the tank [m], where given.
    pub tank_length_m: Option<f64>,
    /// Speed at a Froude number of one [m/s].
    pub froude_one_m_s: f64,
    /// Events that the loop has taken.
    pub n_events: u64,
    /// The daemon's clock [s] when this was written.
    pub at_s: f64,
}

/// One device.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct DeviceStatus {
    /// Its name.
    pub name: String,
    /// Its port.
    pub port: String,
    /// Whether the port is open.
    pub linked: bool,
    /// What it says it is, where it can.
    pub identity: Option<String>,
    /// What a person must mend, told last; none once samples come again.
    pub trouble: Option<String>,
    /// How often the link was lost.
    pub n_losses: u64,
    /// Gaps in its samples.
    pub n_gaps: u64,
    /// Events that found no place in the port's queue.
    pub n_dropped: u64,
    /// Its channels.
    pub channels: Vec<ChannelStatus>,
}

/// One channel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelStatus {
    /// What it measures.
    pub quantity: Quantity,
    /// Its unit.
    pub unit: &'static str,
    /// Its last value.
    pub value: Option<f64>,
    /// Time of that [s].
    pub time_s: Option<f64>,
    /// What is wrong with that, in words.
    pub quality: Vec<&'static str>,
    /// Its time is at most so far off [s].
    pub bound_s: Option<f64>,
    /// Its raw readings of the last seconds.
    pub recent: Option<RecentRaw>,
    /// Counts since the session began.
    pub counts: Counts,
}

/// Raw readings of the last seconds, from which a zero can be taken.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RecentRaw {
    /// How many.
    pub n_readings: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation.
    pub sd: f64,
}

/// What the recorder has done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct RecordedStatus {
    /// Records taken.
    pub records: u64,
    /// Records that came after recording had stopped, and are lost.
    pub unrecorded: u64,
    /// Bytes of the growing file.
    pub part_bytes: u64,
    /// Whether recording has stopped for want of room, or because the disk failed.
    pub stopped: bool,
}

/// What became of the runs.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct RunsStatus {
    /// Runs found.
    pub n_found: u64,
    /// Runs identified and reported.
    pub n_identified: u64,
    /// Runs that say nothing.
    pub n_refused: u64,
    /// Stretches that were not used.
    pub n_rejected: u64,
    /// Runs that found no place in the queue; a replay has them.
    pub n_unheard: u64,
    /// From the sample by which its end is known to the report on disk, of the latest runs
    /// [s, world's time].
    pub latencies_s: Vec<f64>,
    /// From the last sample of each of these runs to the one by which its end is known [s].
    pub known_after_s: Vec<f64>,
    /// What was told of each of these runs before its end was known.
    pub told_before: Vec<ToldBefore>,
}

/// The provisional reports of a run, seen from its final one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ToldBefore {
    /// From the run's last sample to the first report on disk that holds it [s]: the final one
    /// where no provisional one did.
    pub first_after_s: f64,
    /// By how much that one ended later than the final one [s]; none where it is the final one.
    pub first_ends_later_s: Option<f64>,
    /// How far the final damping lies from that one's, in standard deviations of the final one [-].
    pub first_moved_sd: Option<f64>,
    /// By how much the last provisional report ended later than the final one [s].
    pub last_ends_later_s: Option<f64>,
    /// How far the final damping lies from that one's, likewise [-].
    pub last_moved_sd: Option<f64>,
}

/// Latencies that are kept.
const LATENCIES_KEPT: usize = 1000;

impl RunsStatus {
    /// One more report, so long after the sample by which the end of its run was known, that so
    /// long after the last of the run, and what was told of it before.
    pub fn reported(&mut self, latency_s: f64, known_after_s: f64, before: ToldBefore) {
        self.n_identified += 1;
        if self.latencies_s.len() == LATENCIES_KEPT {
            self.latencies_s.remove(0);
            self.known_after_s.remove(0);
            self.told_before.remove(0);
        }
        self.latencies_s.push(latency_s);
        self.known_after_s.push(known_after_s);
        self.told_before.push(before);
    }
}

impl Status {
    /// Whether every device is linked, brings samples of every channel, and is recorded.
    pub fn is_ready(&self) -> bool {
        !self.devices.is_empty() && self.waits_for().is_empty()
    }

    /// What keeps it from being ready, in sentences.
    pub fn waits_for(&self) -> Vec<String> {
        let mut waits = Vec::new();
        if let Some(by) = &self.paused_by {
            waits.push(format!("recording was stopped by {by}"));
        }
        if self.recorded.stopped {
            waits.push("recording has stopped: the disk is full or fails".to_owned());
        }
        for device in &self.devices {
            let name = &device.name;
            match &device.trouble {
                Some(trouble) => waits.push(trouble.clone()),
                None if !device.linked => waits.push(format!("device \"{name}\" is not linked")),
                None => {}
            }
            for channel in device.channels.iter().filter(|channel| channel.is_silent(self.at_s)) {
                let channel = channel.quantity.name();
                waits.push(format!("device \"{name}\" brings no {channel}"));
            }
        }
        waits
    }
}

impl ChannelStatus {
    /// The unit in which it is shown: people read roll in degrees.
    pub fn shown_unit(&self) -> &'static str {
        if self.quantity == Quantity::Roll { "deg" } else { self.unit }
    }

    /// Whether it has brought nothing of late, at that time [s].
    pub fn is_silent(&self, at_s: f64) -> bool {
        self.time_s.is_none_or(|time_s| at_s - time_s >= READY_S)
    }
}

/// A channel without a sample for so long is not ready [s].
const READY_S: f64 = 2.0;
