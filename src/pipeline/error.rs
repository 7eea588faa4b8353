//! What keeps a campaign from being replayed.

use devices::DeviceError;
use replay::ReplayError;

use super::ListenerError;

/// A replay that cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// A recording cannot be read, from its start or from some line on.
    #[error(transparent)]
    Recording {
        /// What the player saw.
        source: Box<ReplayError>,
    },
    /// A device other than a recording cannot go on.
    #[error(transparent)]
    Device {
        /// What the device says.
        source: DeviceError,
    },
    /// Two recordings were made at the same time.
    #[error(
        "recordings \"{first}\" ({first_start_s:.3} s to {first_end_s:.3} s) and \"{second}\" \
         (from {second_start_s:.3} s) overlap in time"
    )]
    Overlap {
        /// The one read first.
        first: String,
        /// Its first time stamp [s].
        first_start_s: f64,
        /// Its last time stamp [s].
        first_end_s: f64,
        /// The other one.
        second: String,
        /// Its first time stamp [s].
        second_start_s: f64,
    },
    /// A run was identified, but could not be kept.
    #[error("run \"{run}\"")]
    Listener {
        /// Id of the run.
        run: String,
        /// Why it was not kept.
        source: ListenerError,
    },
}

impl PipelineError {
    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::Recording { source } => source.hint(),
            Self::Overlap { second, .. } => Some(format!(
                "one is a copy or its clock was wrong: leave \"{second}\" out of [[recording]], or \
                 name both in one `files = {{ roll = ..., force = ... }}` if they hold different \
                 channels of one pass"
            )),
            Self::Device { .. } | Self::Listener { .. } => None,
        }
    }
}

impl From<ReplayError> for PipelineError {
    fn from(source: ReplayError) -> Self {
        Self::Recording { source: Box::new(source) }
    }
}

impl From<DeviceError> for PipelineError {
    /// A recording names its file and line itself, so its error stands without the device's.
    fn from(error: DeviceError) -> Self {
        let DeviceError { device, source } = error;
        match source.downcast::<ReplayError>() {
            Ok(source) => Self::Recording { source },
            Err(source) => Self::Device { source: DeviceError { device, source } },
        }
    }
}
