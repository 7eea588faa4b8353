//! What can be asked of the daemon from outside.

use tokio::sync::mpsc;

/// One thing asked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Order {
    /// Finish the recording and end.
    Terminate,
    /// Read the campaign file again, and follow it from the next rest on.
    Reload,
    /// A run was judged or a diagnosis made: what was learnt is to be told again.
    TellAgain,
    /// Finish the recording; samples come and are shown, but are not kept.
    StopRecording {
        /// Who wants it.
        by: String,
    },
    /// Record again.
    StartRecording,
}

/// The end by which the daemon is asked; it may be cloned to every thread.
pub type Orders = mpsc::Sender<Order>;

/// Orders that may wait.
const ORDERS_WAITING: usize = 16;

/// A queue of orders.
pub fn orders() -> (Orders, mpsc::Receiver<Order>) {
    mpsc::channel(ORDERS_WAITING)
}
