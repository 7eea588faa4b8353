//! Why a recording ended, and what is left of its session.

use tokio::sync::mpsc::Receiver;

use super::attaching::Before;
use super::event::Event;
use super::keeping::Keeper;
use crate::campaign::Campaign;

/// Why a recording ended.
pub(super) enum Ended {
    /// The daemon is to end.
    Terminated,
    /// A new campaign file is in force.
    Reloaded(Box<Reload>),
    /// The recording was long enough.
    Rotated,
    /// Somebody, who is named, wants no recording for a while.
    Paused(String),
    /// It is wanted again.
    Resumed,
    /// The disk is full, or fails.
    BrokenOff,
    /// The disk has room again.
    RoomAgain,
}

impl Ended {
    /// What the recording says of its end.
    pub(super) fn reason(&self) -> &'static str {
        match self {
            Self::Terminated => "the daemon was asked to end",
            Self::Reloaded(_) => "a new campaign file came into force",
            Self::Rotated => "it was long enough",
            Self::Paused(_) | Self::Resumed => "somebody stopped the recording",
            Self::BrokenOff => "the disk is full, or fails",
            Self::RoomAgain => "the disk has room again",
        }
    }

    /// Whether the next session takes the open links over: there was no recording that ended.
    pub(super) fn hands_over(&self) -> bool {
        matches!(self, Self::Resumed | Self::RoomAgain)
    }
}

/// What is left of a session when its loop has ended.
pub(super) struct Over {
    pub(super) ended: Ended,
    pub(super) keeper: Keeper,
    /// Links for the next session, and where their events wait.
    pub(super) links: Option<(Before, Receiver<Event>)>,
}

/// A campaign file that was read again.
pub(super) struct Reload {
    pub(super) campaign: Campaign,
    /// Its text, as it was when it was read.
    pub(super) text: String,
}
