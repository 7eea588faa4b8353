//! Threads between the ports and the loop: one per device, each ended by one flag.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{Scope, ScopedJoinHandle};
use std::time::Duration;

use devices::port::LinkReader;
use tokio::sync::mpsc::Sender;

use super::event::Event;

/// Longest wait for an event before the flag is looked at.
const WAIT: Duration = Duration::from_millis(50);

/// Ends every device's thread.
#[derive(Clone, Default)]
pub(super) struct Detach {
    flag: Arc<AtomicBool>,
}

impl Detach {
    pub(super) fn now(&self) {
        self.flag.store(true, Ordering::Release);
    }

    pub(super) fn is_wanted(&self) -> bool {
        self.flag.load(Ordering::Acquire)
    }
}

/// Passes the events of a port on; what the loop is too slow for waits in the port's own queue.
pub(super) fn forward<'s>(
    scope: &'s Scope<'s, '_>,
    device: usize,
    reader: LinkReader,
    events: Sender<Event>,
    detach: Detach,
) -> ScopedJoinHandle<'s, ()> {
    scope.spawn(move || {
        while !detach.is_wanted() {
            let Some(link) = reader.next(WAIT) else { continue };
            if events.blocking_send(Event::Link { device, link }).is_err() {
                return;
            }
        }
        // The port is closed first, so that nothing comes behind the last event.
        for link in reader.close() {
            if events.blocking_send(Event::Link { device, link }).is_err() {
                return;
            }
        }
        // A loop that is gone needs no last word.
        events.blocking_send(Event::Detached).ok();
    })
}
