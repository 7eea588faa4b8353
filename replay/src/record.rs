//! What a recording holds: one closed enum of records, each with its time.

use std::sync::Arc;

use devices::Sample;
use devices::channel::{Brought, Counts};
use serde::{Deserialize, Serialize};

/// One thing that happened in the tank; its time is on the recording's own time base.
#[derive(Debug, Clone, PartialEq)]
pub enum Record {
    /// A decoded sample.
    Sample(Sample),
    /// Bytes as they passed a port, so that a replay can decode them anew.
    Raw(Raw),
    /// An instrument that was attached.
    Device(AttachedDevice),
    /// A channel's calibration, in force from here on.
    Calibration(Calibration),
    /// The campaign file, in force from here on.
    Campaign(CampaignFile),
    /// The computer's clocks, read together.
    Clock(ClockReading),
    /// A run was found to begin.
    RunStart(RunStart),
    /// A run ended, or was ended.
    RunStop(RunStop),
    /// A stretch that was taken for no run, or a run that was refused.
    Rejection(Rejection),
    /// What was identified from a run.
    Result(RunResult),
    /// A stretch without samples.
    Gap(Gap),
    /// Samples that were lost, repeated, over range or damaged.
    Loss(Loss),
    /// The flags of a channel's samples from here on.
    Quality(QualityChange),
}

/// What happened on a link: bytes in one reading or one command, or the link itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Raw {
    /// Name of the device.
    pub device: Arc<str>,
    /// When the bytes were there, stamped before they were decoded [s].
    pub time_s: f64,
    /// Which way they went, or what else happened.
    pub direction: Direction,
    /// The bytes; for a loss what was seen, in words.
    pub bytes: Vec<u8>,
}

/// Which way bytes went through a port, or what else happened on its link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// From the instrument.
    Received,
    /// To the instrument.
    Sent,
    /// Nowhere: the link was opened.
    Opened,
    /// Nowhere: the link was open already, and the recording joins it here; the bytes tell when the
    /// round of questions that begins was due [ns].
    Joined,
    /// Nowhere: waiting for an answer was given up.
    Waited,
    /// Nowhere: the link was lost.
    Lost,
    /// They were dropped, as nobody took them; the bytes tell how many events.
    Dropped,
    /// Nowhere: what follows on the link is in the recording before too, with its samples; here it
    /// brings the decoder and the clock to where they were.
    Before,
    /// Nowhere: from here on what comes on the link is this recording's.
    Begun,
}

/// An instrument with all that its driver needs to decode its bytes again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AttachedDevice {
    /// When it was attached [s].
    pub time_s: f64,
    /// Name of the device.
    pub device: String,
    /// Name of its profile.
    pub profile: String,
    /// Its port, by its stable id.
    pub port: String,
    /// Settings of the driver, as the text of a TOML table.
    pub settings: String,
}

/// How a channel's readings become SI values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// From when it is in force [s].
    pub time_s: f64,
    /// Name of the device.
    pub device: String,
    /// Name of the channel.
    pub channel: String,
    /// Who took it.
    pub by: String,
    /// Date and time at which it was taken.
    pub taken: String,
    /// The calibration itself, as the text of a TOML table.
    pub definition: String,
}

/// The campaign file's text, again whenever it changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CampaignFile {
    /// From when it is in force [s].
    pub time_s: f64,
    /// The text.
    pub text: String,
}

/// The computer's clocks at one instant: only their differences over a run tell of steps and drift.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClockReading {
    /// The instant [s].
    pub time_s: f64,
    /// `CLOCK_MONOTONIC` [ns].
    pub monotonic_ns: u64,
    /// `CLOCK_REALTIME` [ns].
    pub realtime_ns: u64,
    /// Atomic time less UTC, as the system knows it [s].
    pub tai_offset_s: i32,
}

/// A run's beginning.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunStart {
    /// When the run was found [s].
    pub time_s: f64,
    /// Identifier of the run, unique in the recording.
    pub run: String,
    /// Decay or forced.
    pub kind: String,
    /// The condition that was tested.
    pub condition: String,
    /// When it had begun [s].
    pub start_s: f64,
}

/// How a run or a recording ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExitStatus {
    /// As it should.
    Success,
    /// Somebody, or a limit, stopped it.
    Abort,
    /// Something broke.
    Fail,
    /// The program that recorded died; what it had written was recovered.
    Recovered,
}

/// A run's end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunStop {
    /// When the end was found [s].
    pub time_s: f64,
    /// Identifier of the run.
    pub run: String,
    /// When it had begun [s].
    pub start_s: f64,
    /// When it had ended [s].
    pub end_s: f64,
    /// How it ended.
    pub exit_status: ExitStatus,
    /// Why it ended.
    pub reason: String,
    /// What was counted on each channel between start and end.
    pub counts: Vec<ChannelCounts>,
}

/// Samples of one channel, good and bad.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ChannelCounts {
    /// Name of the channel.
    pub channel: String,
    /// Samples recorded.
    pub samples: u64,
    /// Samples that never arrived, where that can be told.
    pub lost: u64,
    /// Samples that repeat the one before because the instrument had no newer one.
    pub repeated: u64,
    /// Samples beyond the channel's range.
    pub over_range: u64,
    /// Samples whose check failed.
    pub damaged: u64,
    /// Their times are at most so far off [s]; none where that is not known.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub clock_bound_s: Option<f64>,
}

impl ChannelCounts {
    /// What a channel brought, under its name.
    pub fn of(brought: &Brought) -> Self {
        let Counts { received, lost, repeated, over_range, damaged } = brought.counts;
        Self {
            channel: brought.quantity.name().to_owned(),
            samples: received,
            lost,
            repeated,
            over_range,
            damaged,
            clock_bound_s: brought.bound_s,
        }
    }
}

/// Why a stretch of the recording gave no run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rejection {
    /// When it was decided [s].
    pub time_s: f64,
    /// Where the stretch begins [s].
    pub start_s: f64,
    /// Where it ends [s].
    pub end_s: f64,
    /// Why.
    pub reason: String,
}

/// What was identified from a run, as a document of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// When it was known [s].
    pub time_s: f64,
    /// Identifier of the run.
    pub run: String,
    /// Name and version of the document's form.
    pub schema: String,
    /// The document, as JSON text.
    pub document: String,
}

/// A stretch in which a device or a channel brought nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gap {
    /// When it was over, or known to be one [s].
    pub time_s: f64,
    /// Name of the device.
    pub device: String,
    /// Name of the channel; empty when all of the device's are meant.
    pub channel: String,
    /// Time of the last sample before [s].
    pub start_s: f64,
    /// Time of the first sample after [s].
    pub end_s: f64,
    /// Samples missing, where that can be told.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub lost: Option<u64>,
    /// What was seen: link lost, sequence jumped.
    pub reason: String,
}

/// What is wrong with the samples of a [`Loss`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossKind {
    /// They never arrived, or a full queue dropped them.
    Lost,
    /// They repeat the one before.
    Repeated,
    /// They are beyond the channel's range.
    OverRange,
    /// Their check failed.
    Damaged,
}

/// Samples of a channel that are missing or not to be trusted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Loss {
    /// When it was seen [s].
    pub time_s: f64,
    /// Name of the device.
    pub device: String,
    /// Name of the channel.
    pub channel: String,
    /// What is wrong.
    pub kind: LossKind,
    /// With how many.
    pub count: u64,
}

/// What is wrong with a channel's samples from the next on, until it changes again; before the
/// first of them nothing is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct QualityChange {
    /// Time of the first sample of that quality [s].
    pub time_s: f64,
    /// Name of the device.
    pub device: String,
    /// Name of the channel.
    pub channel: String,
    /// Names of its flags, one after the other: over range, lagged; empty where nothing is wrong.
    pub flags: String,
}

impl From<Sample> for Record {
    fn from(sample: Sample) -> Self {
        Self::Sample(sample)
    }
}

impl From<&Sample> for Record {
    fn from(sample: &Sample) -> Self {
        Self::Sample(*sample)
    }
}

impl Record {
    /// Its time on the recording's own time base [s].
    pub fn time_s(&self) -> f64 {
        match self {
            Self::Sample(sample) => sample.time_s,
            Self::Raw(raw) => raw.time_s,
            Self::Device(device) => device.time_s,
            Self::Calibration(calibration) => calibration.time_s,
            Self::Campaign(campaign) => campaign.time_s,
            Self::Clock(clock) => clock.time_s,
            Self::RunStart(start) => start.time_s,
            Self::RunStop(stop) => stop.time_s,
            Self::Rejection(rejection) => rejection.time_s,
            Self::Result(result) => result.time_s,
            Self::Gap(gap) => gap.time_s,
            Self::Loss(loss) => loss.time_s,
            Self::Quality(change) => change.time_s,
        }
    }

    /// Whether every number in it is finite, so that JSON can hold it.
    pub(crate) fn is_finite(&self) -> bool {
        let numbers = match self {
            Self::Sample(sample) => [sample.value, 0.0],
            Self::RunStart(start) => [start.start_s, 0.0],
            Self::RunStop(stop) => [stop.start_s, stop.end_s],
            Self::Rejection(rejection) => [rejection.start_s, rejection.end_s],
            Self::Gap(gap) => [gap.start_s, gap.end_s],
            _ => [0.0; 2],
        };
        self.time_s().is_finite() && numbers.iter().all(|number| number.is_finite())
    }
}
