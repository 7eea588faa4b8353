//! What keeps the daemon from its work.

use std::io;
use std::path::{Path, PathBuf};

use devices::{AttachmentError, InstrumentError};
use replay::ReplayError;

use crate::campaign::{FILE_NAME, Mistake};
use crate::page::ServeError;

/// A daemon that cannot start, or could not finish a recording.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// The campaign file is wrong.
    #[error("{} mistake(s) in the campaign file", mistakes.len())]
    Campaign {
        /// Every mistake in it.
        mistakes: Vec<Mistake>,
    },
    /// A campaign without instruments.
    #[error("campaign \"{}\" has no [[device]]", folder.display())]
    NoDevices {
        /// Its folder.
        folder: PathBuf,
    },
    /// An instrument that cannot be attached.
    #[error(transparent)]
    Instrument {
        /// Why not.
        #[from]
        source: InstrumentError,
    },
    /// An instrument whose settings no recording can hold.
    #[error("device \"{device}\" cannot be recorded")]
    Attachment {
        /// The device.
        device: String,
        /// Why not.
        source: AttachmentError,
    },
    /// A recording that cannot be begun or finished.
    #[error(transparent)]
    Recording {
        /// Why not.
        #[from]
        source: ReplayError,
    },
    /// A file or folder that cannot be read or made.
    #[error("\"{}\"", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A page that cannot be served.
    #[error(transparent)]
    Serve {
        /// Why not.
        #[from]
        source: ServeError,
    },
    /// The system gives no thread, signal or socket.
    #[error("the system gives no {what}")]
    System {
        /// What was asked for.
        what: String,
        /// What the system said.
        source: io::Error,
    },
}

impl LiveError {
    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::NoDevices { .. } => Some(
                "describe each instrument in a [[device]] with name, profile, port and \
                 [[device.channel]]; `rolltank devices` lists profiles and ports"
                    .to_owned(),
            ),
            Self::Instrument { source } => source.hint(),
            Self::Recording { source } => source.hint(),
            Self::File { .. } => {
                Some("check that the folder can be written and that the disk has room".to_owned())
            }
            Self::Serve { source } => Some(source.hint().to_owned()),
            Self::Campaign { .. } | Self::Attachment { .. } | Self::System { .. } => None,
        }
    }
}

/// The mistake of a campaign file that is to be followed live and has no instruments.
pub(super) fn no_devices(folder: &Path) -> Mistake {
    let error = LiveError::NoDevices { folder: folder.to_owned() };
    Mistake {
        file: folder.join(FILE_NAME).display().to_string(),
        line: None,
        message: error.to_string(),
        hint: error.hint(),
    }
}

impl From<Vec<Mistake>> for LiveError {
    fn from(mistakes: Vec<Mistake>) -> Self {
        Self::Campaign { mistakes }
    }
}
