//! Has the disk keep a growing file, on a thread of its own so that the writer never waits for it.

use std::fs::File;
use std::io;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

/// A thread that calls `fdatasync` whenever it is asked.
///
/// A disk may take half a second over it; the writer would meanwhile hold samples that only a queue
/// in memory keeps.
pub(crate) struct Syncer {
    /// None once the thread is to end.
    requests: Option<SyncSender<()>>,
    failures: Receiver<io::Error>,
    thread: Option<JoinHandle<()>>,
}

impl Syncer {
    /// Starts the thread on another handle of the file.
    pub(crate) fn start(file: &File) -> io::Result<Self> {
        let file = file.try_clone()?;
        // One request may wait while one is served: it covers all that was written before either.
        let (requests, asked) = sync_channel(1);
        let (failed, failures) = sync_channel(1);
        let serve = move || {
            for () in asked {
                if let Err(error) = file.sync_data() {
                    // The first failure is told; the kernel forgets what it could not keep, so
                    // that a later success would prove nothing.
                    drop(failed.try_send(error));
                    return;
                }
            }
        };
        let thread = thread::Builder::new().name("recorder-sync".to_owned()).spawn(serve)?;
        Ok(Self { requests: Some(requests), failures, thread: Some(thread) })
    }

    /// Asks for all that was written so far.
    pub(crate) fn ask(&self) {
        // A full queue holds a request that covers this one; a thread that ended left its failure.
        if let Some(requests) = &self.requests {
            let _ = requests.try_send(());
        }
    }

    /// What went wrong, once.
    pub(crate) fn failure(&self) -> Option<io::Error> {
        self.failures.try_recv().ok()
    }

    /// Waits until the thread has served what it was asked.
    pub(crate) fn stop(mut self) -> io::Result<()> {
        self.join();
        self.failure().map_or(Ok(()), Err)
    }

    fn join(&mut self) {
        self.requests = None;
        // The thread runs no code that panics.
        drop(self.thread.take().map(JoinHandle::join));
    }
}

impl Drop for Syncer {
    /// The thread's handle of the file shares its lock, which is to end with the recorder.
    fn drop(&mut self) {
        self.join();
    }
}
