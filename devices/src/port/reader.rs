//! One thread per port: opens, stamps, converses, notices loss, and comes back.

use std::any::Any;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::{Arrival, BY_ID_FOLDER, LinkEvent, LinkOptions, Port, PortFault, found_ports};
use crate::clock::Clock;
use crate::driver::Session;
use crate::realtime::become_realtime;

/// Longest wait for bytes before the port itself is looked at again; a hang-up ends it at once.
const IDLE_MAX_MS: u64 = 25;
/// From one attempt to open to the next.
const RETRY_MS: u64 = 200;
/// Without a byte for so long, the silence is told [ns].
const SILENCE_NS: u64 = 1_000_000_000;
/// Events that may wait; at 2 kHz more than five seconds of them.
const QUEUE_EVENTS: usize = 16_384;
const READ_BYTES: usize = 4096;

/// Takes what happened; whether there was room for it.
pub type Outlet = Box<dyn FnMut(LinkEvent) -> bool + Send>;

/// The thread of one port, which ends when it is dropped.
pub struct LinkThread {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl LinkThread {
    /// Starts the thread; it opens the port when that is there, and never waits for the outlet.
    ///
    /// # Errors
    /// The system's error when it has no thread to give.
    pub fn start(
        options: LinkOptions,
        session: Session,
        clock: Arc<dyn Clock>,
        outlet: Outlet,
    ) -> std::io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let outlet = CountedOutlet { outlet, n_dropped: 0 };
        let mut link = Link { options, session, clock, outlet, stop: Arc::clone(&stop) };
        let thread = thread::Builder::new().name("port".to_owned()).spawn(move || {
            if link.options.realtime {
                link.become_realtime();
            }
            link.serve();
        })?;
        Ok(Self { stop, thread: Some(thread) })
    }

    /// Asks the thread to close the port and to end, without waiting for it.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Release);
        if let Some(thread) = &self.thread {
            thread.thread().unpark();
        }
    }
}

impl Drop for LinkThread {
    fn drop(&mut self) {
        self.stop();
        if let Some(thread) = self.thread.take() {
            // What panics in the thread is caught there.
            drop(thread.join());
        }
    }
}

/// The thread of one port, and a queue of what happened on it.
pub struct LinkReader {
    events: Receiver<LinkEvent>,
    _thread: LinkThread,
}

impl LinkReader {
    /// Starts the thread, as [`LinkThread::start`] does.
    ///
    /// # Errors
    /// The system's error when it has no thread to give.
    pub fn start(
        options: LinkOptions,
        session: Session,
        clock: Arc<dyn Clock>,
    ) -> std::io::Result<Self> {
        let (sender, events) = sync_channel(QUEUE_EVENTS);
        let outlet = Box::new(move |event| sender.try_send(event).is_ok());
        Ok(Self { events, _thread: LinkThread::start(options, session, clock, outlet)? })
    }

    /// The next event, waited for at most so long.
    pub fn next(&self, wait: Duration) -> Option<LinkEvent> {
        self.events.recv_timeout(wait).ok()
    }
}

/// An outlet that tells how much found no room in it, as soon as there is some.
struct CountedOutlet {
    outlet: Outlet,
    n_dropped: u64,
}

impl CountedOutlet {
    fn send(&mut self, event: LinkEvent) {
        if self.n_dropped > 0 && (self.outlet)(LinkEvent::Overflow { n_events: self.n_dropped }) {
            self.n_dropped = 0;
        }
        if self.n_dropped > 0 || !(self.outlet)(event) {
            self.n_dropped += 1;
        }
    }
}

struct Link {
    options: LinkOptions,
    session: Session,
    clock: Arc<dyn Clock>,
    outlet: CountedOutlet,
    stop: Arc<AtomicBool>,
}

impl Link {
    /// Where the system does not allow it, the thread is an ordinary one, which the log says.
    fn become_realtime(&self) {
        let port = self.options.path.display();
        if become_realtime() {
            tracing::info!(%port, "its thread has SCHED_FIFO");
        } else {
            tracing::info!(%port, "no SCHED_FIFO: times are worse while the machine is busy; \
                LimitRTPRIO=20 or CAP_SYS_NICE allows it");
        }
    }

    /// Runs until it is stopped; after a panic, which is told as a loss of the link, anew.
    fn serve(&mut self) {
        // The next opening starts the session anew, and nothing else outlives a conversation.
        while let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.run())) {
            self.lost(format!("reading it failed: {}", words_of(panic.as_ref())));
            self.rest();
        }
    }

    fn run(&mut self) {
        let mut told: Option<PortFault> = None;
        while !self.stopped() {
            match Port::open(&self.options.path, self.options.line) {
                Ok(port) => {
                    told = None;
                    self.talk(port);
                }
                Err(fault) => {
                    if told.as_ref() != Some(&fault) {
                        let at_ns = self.clock.now_ns();
                        let found = found_ports(Path::new(BY_ID_FOLDER));
                        let present = found.into_iter().map(|port| port.path).collect();
                        told = Some(fault.clone());
                        self.outlet.send(LinkEvent::Absent { at_ns, fault, present });
                    }
                    self.rest();
                }
            }
        }
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Acquire)
    }

    /// Waits before the next attempt, but not for a stop.
    fn rest(&self) {
        // Woken before its time for no reason, it only tries earlier.
        if !self.stopped() {
            thread::park_timeout(Duration::from_millis(RETRY_MS));
        }
    }

    /// Converses until the link is lost or stopped.
    fn talk(&mut self, mut port: Port) {
        let device = fs::canonicalize(&self.options.path).ok();
        let mut at_ns = self.clock.now_ns();
        self.session.open(at_ns);
        self.outlet.send(LinkEvent::Opened { at_ns });
        let mut heard_ns = Some(at_ns);
        let mut buffer = vec![0; READ_BYTES];
        while !self.stopped() {
            if let Err(seen) = self.send_due(&mut port) {
                return self.lost(seen);
            }
            let wait = self.wait();
            match port.read(&mut buffer, wait) {
                Arrival::Bytes(n_bytes) => {
                    at_ns = self.clock.now_ns();
                    heard_ns = Some(at_ns);
                    let bytes = buffer[..n_bytes].to_vec();
                    let mut decoded = Vec::new();
                    self.session.receive(&bytes, at_ns, &mut decoded);
                    self.outlet.send(LinkEvent::Received { at_ns, bytes, decoded });
                }
                Arrival::Lost(seen) => return self.lost(seen),
                Arrival::Idle => {
                    at_ns = self.clock.now_ns();
                    if wait.as_millis() >= u128::from(IDLE_MAX_MS)
                        && device != fs::canonicalize(&self.options.path).ok()
                    {
                        return self.lost(seen_at(&self.options.path));
                    }
                    if heard_ns.is_some_and(|heard_ns| at_ns - heard_ns > SILENCE_NS) {
                        heard_ns = None;
                        self.outlet.send(LinkEvent::Silence { at_ns });
                    }
                }
            }
        }
    }

    /// Sends what is due and tells what was given up.
    fn send_due(&mut self, port: &mut Port) -> Result<(), String> {
        let at_ns = self.clock.now_ns();
        let (mut bytes, mut decoded) = (Vec::new(), Vec::new());
        self.session.poll(at_ns, &mut bytes, &mut decoded);
        if bytes.is_empty() {
            if !decoded.is_empty() {
                self.outlet.send(LinkEvent::Waited { at_ns, decoded });
            }
            return Ok(());
        }
        if let Some(due_ns) = self.session.round_due_ns() {
            self.outlet.send(LinkEvent::Round { at_ns, due_ns });
        }
        let written = port.write(&bytes);
        self.outlet.send(LinkEvent::Sent { at_ns, bytes, decoded });
        written
    }

    fn wait(&self) -> Duration {
        let longest = Duration::from_millis(IDLE_MAX_MS);
        let Some(wake_ns) = self.session.wake_ns() else { return longest };
        self.clock.real(wake_ns.saturating_sub(self.clock.now_ns())).min(longest)
    }

    fn lost(&mut self, seen: String) {
        let at_ns = self.clock.now_ns();
        self.outlet.send(LinkEvent::Lost { at_ns, seen });
    }
}

/// What a panic said.
fn words_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic without words")
}

fn seen_at(path: &Path) -> String {
    let now = if path.exists() { "points to another device" } else { "has vanished" };
    format!("{} {now}", path.display())
}
