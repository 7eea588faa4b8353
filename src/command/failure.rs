//! Why a command could not do its work, told with hints and an exit code.

use std::error::Error;
use std::io::{self, Write};
use std::iter::successors;
use std::path::PathBuf;

use super::Exit;
use crate::campaign::{LoadsError, Mistake};
use crate::live::LiveError;
use crate::pipeline::{PipelineError, PrintError, WriteError};
use crate::tank::{ScenarioError, TankError};
use ::devices::channel::CalibrationError;
use ::devices::{InstrumentError, Quantity};
use ::replay::ReplayError;

/// A command that could not do its work.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The campaign file is wrong.
    #[error("{} mistake(s) in the campaign file", mistakes.len())]
    Campaign {
        /// Every mistake in it.
        mistakes: Vec<Mistake>,
    },
    /// The daemon cannot do its work.
    #[error(transparent)]
    Live {
        /// Why not.
        source: LiveError,
    },
    /// An instrument does not do what it should.
    #[error(transparent)]
    Instrument {
        /// What is wrong with it.
        source: InstrumentError,
    },
    /// A port is in use, most likely by the daemon.
    #[error(transparent)]
    PortInUse {
        /// Whose.
        source: InstrumentError,
    },
    /// The page of the daemon does not answer as it should.
    #[error("the page of `rolltank run`")]
    Page {
        /// What was seen.
        source: io::Error,
    },
    /// The readings of a channel make no calibration.
    #[error("device \"{device}\": {}: {source}", quantity.name())]
    Calibration {
        /// The device.
        device: String,
        /// The channel.
        quantity: Quantity,
        /// Why not.
        source: CalibrationError,
    },
    /// The loads of a channel make no curve.
    #[error("device \"{device}\": {}: {source}", quantity.name())]
    Loads {
        /// The device.
        device: String,
        /// The channel.
        quantity: Quantity,
        /// What they lack.
        source: LoadsError,
    },
    /// No instrument measures a channel that is to be calibrated.
    #[error("no [[device]] measures the {}", quantity.name())]
    NotMeasured {
        /// The channel.
        quantity: Quantity,
    },
    /// The scenario is wrong.
    #[error(transparent)]
    Scenario {
        /// What is wrong with it.
        #[from]
        source: ScenarioError,
    },
    /// The campaign cannot be replayed.
    #[error(transparent)]
    Replay {
        /// Why not.
        #[from]
        source: PipelineError,
    },
    /// A recording cannot be brought in.
    #[error(transparent)]
    Import {
        /// Why not.
        #[from]
        source: ReplayError,
    },
    /// The results cannot be written.
    #[error(transparent)]
    Results {
        /// Why not.
        #[from]
        source: WriteError,
    },
    /// The report cannot be printed.
    #[error(transparent)]
    Print {
        /// Why not.
        #[from]
        source: PrintError,
    },
    /// A figure cannot be measured.
    #[error("the campaign cannot be measured: {0}")]
    Bench(String),
    /// The simulated campaign cannot be written.
    #[error(transparent)]
    Tank {
        /// Why not.
        #[from]
        source: TankError,
    },
    /// A file or folder cannot be read or made.
    #[error("\"{}\"", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A scenario that is neither a file that can be read nor built in.
    #[error("scenario \"{}\" cannot be read", path.display())]
    ScenarioFile {
        /// The file, as it was named.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A folder that was to be written anew holds something.
    #[error("\"{}\" exists already and is not an empty folder", path.display())]
    NotFresh {
        /// The folder.
        path: PathBuf,
    },
    /// A report among the recordings, where its tables would be read as some.
    #[error("\"{}\" is inside the campaign folder, among its recordings", path.display())]
    InsideCampaign {
        /// The folder for the report.
        path: PathBuf,
        /// The folder for the results of the campaign.
        results: PathBuf,
    },
    /// Recordings that cannot be read.
    #[error("{} recording(s) cannot be read", mistakes.len())]
    Recordings {
        /// What is wrong with each.
        mistakes: Vec<Mistake>,
    },
    /// Standard output cannot be written.
    #[error("standard output")]
    Output {
        /// What the system said.
        #[from]
        source: io::Error,
    },
}

impl From<Vec<Mistake>> for Failure {
    fn from(mistakes: Vec<Mistake>) -> Self {
        Self::Campaign { mistakes }
    }
}

impl From<LiveError> for Failure {
    fn from(source: LiveError) -> Self {
        match source {
            LiveError::Campaign { mistakes } => Self::Campaign { mistakes },
            source => Self::Live { source },
        }
    }
}

impl Failure {
    /// How the command ends.
    pub fn exit(&self) -> Exit {
        match self {
            Self::Campaign { .. }
            | Self::Scenario { .. }
            | Self::ScenarioFile { .. }
            | Self::NotFresh { .. }
            | Self::InsideCampaign { .. }
            | Self::NotMeasured { .. }
            | Self::Live { source: LiveError::NoDevices { .. } } => Exit::Usage,
            _ => Exit::Failed,
        }
    }

    /// Whether only the reader of standard output went away.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Self::Output { source } if source.kind() == io::ErrorKind::BrokenPipe)
    }

    /// Writes the error, its causes and its hints.
    pub fn tell(&self, err: &mut dyn Write) -> io::Result<()> {
        if let Self::Campaign { mistakes } | Self::Recordings { mistakes } = self {
            for mistake in mistakes {
                writeln!(err, "error: {mistake}")?;
                if let Some(hint) = &mistake.hint {
                    writeln!(err, "hint: {hint}")?;
                }
            }
            return Ok(());
        }
        let (message, hints) = told(self);
        writeln!(err, "error: {message}")?;
        hints.iter().chain(&self.hint()).try_for_each(|hint| writeln!(err, "hint: {hint}"))
    }

    fn hint(&self) -> Option<String> {
        match self {
            Self::Live { source } => source.hint(),
            Self::Instrument { source } => source.hint(),
            Self::PortInUse { .. } => Some(
                "stop `rolltank run`, or let it read: take zeros on its page, calibrate with \
                 --page 127.0.0.1:8440"
                    .to_owned(),
            ),
            Self::Page { .. } => Some("its log names the address: \"serving the page\"".to_owned()),
            Self::Replay { source } => source.hint(),
            Self::Import { source } => source.hint(),
            Self::File { .. } => {
                Some("check that the folder can be written and that the disk has room".to_owned())
            }
            Self::ScenarioFile { .. } => Some(
                "name a scenario file in UTF-8, as docs/scenario.md describes it, or the built-in \
                 scenario paper"
                    .to_owned(),
            ),
            Self::InsideCampaign { results, .. } => {
                Some(format!("name a folder outside, or one below \"{}\"", results.display()))
            }
            Self::NotFresh { .. } => {
                Some("name a new folder with -o; nothing is ever overwritten".to_owned())
            }
            _ => None,
        }
    }
}

/// An error and its causes joined by `": "`, and the hints that follow a message on its own line.
///
/// A cause that its error has told already is not told again.
pub(super) fn told(error: &dyn Error) -> (String, Vec<String>) {
    let mut message = String::new();
    let mut hints = Vec::new();
    for error in successors(Some(error), |error| (*error).source()) {
        let text = error.to_string();
        let mut parts = text.split("\nhint: ");
        let own = parts.next().unwrap_or_default();
        if message.is_empty() {
            message.push_str(own);
        } else if !message.contains(own) {
            message = format!("{message}: {own}");
        }
        hints.extend(parts.map(str::to_owned));
    }
    (message, hints)
}
