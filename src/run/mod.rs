//! Finds runs in the stream: samples are pushed in, runs and rejections come out.
//!
//! Each channel is averaged into bins of a twentieth of a second (`bins`), from which its noise
//! (`noise`) is known. The roll is cut into half cycles between turning points that stand out of
//! that noise (`half_cycles`); the speed into steady stretches (`carriage_pass`). A state
//! machine (`motion`) joins half cycles into a decay as long as `decay` finds each one where
//! the last ones lead, and into a forced run as long as `forced` finds it steady; what the rod
//! drives without repeating is kept by `driven` and is a forced run too. When a run has ended,
//! `usable_end` looks for the instant at which the samples left their course; what the model does
//! after a decay is followed by `aftermath`.
//!
//! Nothing here reads a clock or a file or draws a number, and what is told depends only on the
//! samples in their order. Memory is bounded: at rest the last 20 s are kept, and a run is closed
//! after half an hour or two million samples.

mod aftermath;
mod assembly;
mod bins;
mod carriage_pass;
mod closer;
mod decay;
mod drive;
mod driven;
mod finder;
mod forced;
mod half_cycles;
mod harmonic;
mod limits;
mod motion;
mod noise;
mod passed_over;
mod records;
mod ripple;
mod timing;
mod track;
mod trust;
mod unused;
mod usable_end;

pub use finder::RunFinder;
pub use limits::Limits;
pub(crate) use noise::SampleNoise;
pub use timing::Timing;
pub use usable_end::LEFT_ITS_COURSE;

/// Values of one channel with their times, both of the same length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Times [s] on the recording's time base, never decreasing.
    pub time_s: Vec<f64>,
    /// Values in the SI unit of the channel.
    pub value: Vec<f64>,
}

/// How the model was set rolling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum RunKind {
    /// Heeled, released, left to roll.
    Decay,
    /// Rolled by the oscillator rod.
    Forced,
}

impl RunKind {
    /// The kind as files and contracts write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Decay => "decay",
            Self::Forced => "forced",
        }
    }
}

/// Why the usable stretch of a run ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunEnd {
    /// The roll is lost in the noise.
    LostInNoise,
    /// Something stopped the roll, such as a catching hand.
    Caught,
    /// The carriage speed left its steady value.
    PassEnded,
    /// The model was released or struck again.
    ReStruck,
    /// The excitation changed or stopped.
    ExcitationChanged,
    /// A hole in the record.
    Gap,
    /// The recording ended.
    RecordingEnded,
    /// The longest run that is kept in memory was reached; what follows is another run.
    TooLong,
}

/// The still stretch before a run, from which zeros are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Still {
    /// Start of the stretch [s].
    pub start_s: f64,
    /// End of the stretch [s].
    pub end_s: f64,
    /// Mean roll [rad].
    pub roll_rad: f64,
    /// Standard deviation of the roll about it [rad], noise included.
    pub roll_sd_rad: f64,
    /// Mean rod force [N] or moment [N m], where one is recorded.
    pub force: Option<f64>,
}

/// One experiment: the samples between its start and its end, with what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Decay or forced.
    pub kind: RunKind,
    /// First instant used [s].
    pub start_s: f64,
    /// Last instant used [s].
    pub end_s: f64,
    /// Why it ends there.
    pub end: RunEnd,
    /// Mean carriage speed over the run [m/s], when a speed channel was recorded.
    pub speed_m_s: Option<f64>,
    /// Roll [rad] from `start_s` to `end_s`.
    pub roll: Series,
    /// Roll [rad] just before, as far as it is kept: what remembers had begun by then.
    pub lead: Series,
    /// Rod force [N] or exciting moment [N m] as recorded, over the same stretch, if one was.
    pub drive: Series,
    /// Carriage speed [m/s] over the same stretch, if one was recorded.
    pub speed: Series,
    /// The still stretch before the run, when there was one.
    pub still: Option<Still>,
    /// Frequency of the excitation [rad/s] of a forced run that repeats, as the run finder saw it;
    /// none when the excitation sweeps or is irregular.
    pub excitation_rad_s: Option<f64>,
    /// How well its times are known; whoever read the instruments says so.
    pub timing: Timing,
}

/// What the model did after its release, left alone until it lay still or somebody touched it, as
/// far as no run holds it: it does not decay as its damping alone would have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Aftermath {
    /// End of the decay [s] behind which it begins; none where it begins with the release, because
    /// too little of a decay came first to make a run.
    pub run_end_s: Option<f64>,
    /// Roll [rad].
    pub roll: Series,
    /// Rod force [N] or exciting moment [N m], if one was recorded.
    pub drive: Series,
}

/// A stretch that is not used, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejection {
    /// Start of the stretch [s].
    pub start_s: f64,
    /// End of the stretch [s].
    pub end_s: f64,
    /// The reason, as a sentence with its values and limits.
    pub reason: String,
}

/// What the run finder tells as samples arrive.
#[expect(clippy::large_enum_variant, reason = "each is taken apart as it comes")]
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A run has ended and can be identified.
    Run(Run),
    /// A stretch will not be used.
    Rejected(Rejection),
    /// What followed a decay is known.
    Aftermath(Aftermath),
}
