//! Everything that can happen to the daemon, as one closed enum.

use devices::port::LinkEvent;
use tokio::sync::mpsc;

use super::reporting::Reported;

/// What the loop of a session takes, one after the other.
pub(super) enum Event {
    /// Something happened on the link of a device.
    Link {
        /// Which device, in the order of the campaign file.
        device: usize,
        /// What happened.
        link: LinkEvent,
    },
    /// A device's thread has ended and its last event was taken.
    Detached,
    /// What became of a run.
    Reported(Box<Reported>),
    /// Every run of the recording was reported.
    AllReported,
    /// Somebody wants something.
    Order(Order),
    /// Time has passed.
    Tick,
}

/// What can be asked of the daemon from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Finish the recording and end.
    Terminate,
    /// Read the campaign file again, and follow it from the next rest on.
    Reload,
}

/// The end by which the daemon is asked; it may be cloned to every thread.
pub type Orders = mpsc::Sender<Order>;

/// Orders that may wait.
const ORDERS_WAITING: usize = 16;
/// Events that may wait in the loop's queue; behind it each port has a queue of its own, whose
/// overflow is counted and recorded.
pub(super) const EVENTS_WAITING: usize = 1024;

/// A queue of orders.
pub fn orders() -> (Orders, mpsc::Receiver<Order>) {
    mpsc::channel(ORDERS_WAITING)
}
