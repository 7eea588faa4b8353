//! Why a recording ended, and what is left of its session.

use std::sync::Arc;

use devices::Quantity;
use devices::setup::DeviceConfig;
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

    /// Whether the next session takes the open links over; other instruments are attached anew.
    pub(super) fn hands_over(&self) -> bool {
        match self {
            Self::Terminated => false,
            Self::Reloaded(reload) => reload.keeps_links,
            _ => true,
        }
    }
}

/// What is left of a session when its loop has ended.
pub(super) struct Over {
    pub(super) ended: Ended,
    pub(super) keeper: Keeper,
    /// Links for the next session, and where their events wait.
    pub(super) links: Option<(Before, Receiver<Event>)>,
    /// Where links that are handed over to nobody were left.
    pub(super) left_off: Vec<LeftOff>,
}

/// The last sample of a channel before its port was closed.
pub(super) struct LeftOff {
    /// Name of the device.
    pub(super) device: Arc<str>,
    pub(super) quantity: Quantity,
    pub(super) time_s: f64,
}

/// A campaign file that was read again.
pub(super) struct Reload {
    pub(super) campaign: Campaign,
    /// Its text, as it was when it was read.
    pub(super) text: String,
    /// Whether its instruments are those before, on the same ports; their channels and
    /// calibrations may be others.
    pub(super) keeps_links: bool,
}

/// Whether conversations with instruments before go on with those after.
pub(super) fn keeps_links(before: &[DeviceConfig], after: &[DeviceConfig]) -> bool {
    let link = |device: &DeviceConfig| DeviceConfig { channels: Vec::new(), ..device.clone() };
    before.iter().map(link).eq(after.iter().map(link))
}
