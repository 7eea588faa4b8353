//! What happens on a link, from its opening to its loss.

use std::path::PathBuf;

use super::{Line, PortFault};
use crate::driver::Decoded;

/// What happened on a link; `at_ns` is the host's clock.
///
/// Opened, sent, received, waited and lost are the raw record of a link: with their times and bytes
/// alone a fresh session decodes the same again.
#[derive(Debug, Clone, PartialEq)]
pub enum LinkEvent {
    /// The port is open.
    Opened {
        /// When.
        at_ns: u64,
    },
    /// A round of questions begins; a session that has heard nothing before can go on from here.
    Round {
        /// When.
        at_ns: u64,
        /// When it was due.
        due_ns: u64,
    },
    /// Bytes were sent.
    Sent {
        /// Just before they were written.
        at_ns: u64,
        /// The bytes.
        bytes: Vec<u8>,
        /// What was given up before.
        decoded: Vec<Decoded>,
    },
    /// Bytes were received.
    Received {
        /// Right after the read, before any decoding.
        at_ns: u64,
        /// The bytes.
        bytes: Vec<u8>,
        /// What they said.
        decoded: Vec<Decoded>,
    },
    /// Waiting ended without bytes.
    Waited {
        /// When.
        at_ns: u64,
        /// What was given up.
        decoded: Vec<Decoded>,
    },
    /// The link is open, but not a byte came for a second; told once.
    Silence {
        /// When.
        at_ns: u64,
    },
    /// The link is gone.
    Lost {
        /// When it was noticed.
        at_ns: u64,
        /// What was seen.
        seen: String,
    },
    /// The port cannot be opened; told again only when the reason changes.
    Absent {
        /// When.
        at_ns: u64,
        /// Why.
        fault: PortFault,
        /// The ports that are there instead.
        present: Vec<PathBuf>,
    },
    /// Events were dropped, because nobody took them.
    Overflow {
        /// How many.
        n_events: u64,
    },
}

impl LinkEvent {
    /// When it happened on the host's clock [ns]; none for a loss of events, which has no instant.
    pub fn at_ns(&self) -> Option<u64> {
        match self {
            Self::Opened { at_ns }
            | Self::Round { at_ns, .. }
            | Self::Sent { at_ns, .. }
            | Self::Received { at_ns, .. }
            | Self::Waited { at_ns, .. }
            | Self::Silence { at_ns }
            | Self::Lost { at_ns, .. }
            | Self::Absent { at_ns, .. } => Some(*at_ns),
            Self::Overflow { .. } => None,
        }
    }
}

/// Where and how a link is made.
#[derive(Debug, Clone)]
pub struct LinkOptions {
    /// Stable name of the port.
    pub path: PathBuf,
    /// Its settings.
    pub line: Line,
    /// `SCHED_FIFO` for the thread, when the system allows it.
    pub realtime: bool,
}
