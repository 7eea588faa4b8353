//! Everything that can happen to the daemon, as one closed enum.

use super::reporting::Reported;
use crate::page::Order;
use devices::port::LinkEvent;

/// What the loop of a session takes, one after the other.
pub(super) enum Event {
    /// Something happened on the link of a device.
    Link {
        /// Which device, in the order of the campaign file.
        device: usize,
        /// What happened.
        link: LinkEvent,
    },
    /// What became of a run.
    Reported(Box<Reported>),
    /// Every run of the recording was reported.
    AllReported,
    /// Somebody wants something.
    Order(Order),
    /// Time has passed.
    Tick,
}

/// Events that may wait in the loop's queue; what a port brings beyond is counted and recorded as
/// lost. At four instruments of 2 kHz more than three seconds of them.
pub(super) const EVENTS_WAITING: usize = 32_768;
