//! Whether any program has a file open, as the system tells it.

use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::path::Path;

use rustix::fs::inotify::{self, CreateFlags, ReadFlags, Reader, WatchFlags};
use rustix::io;

/// Counts the openings of a file from now on.
pub(super) struct Openings {
    /// None where the system watches no more files for this user.
    watch: Option<OwnedFd>,
    n_open: u32,
}

impl Openings {
    /// Watches a file; who has it open already is not counted.
    pub(super) fn of(path: &Path) -> Self {
        Self { watch: watched(path).ok(), n_open: 0 }
    }

    /// Whether somebody has it open, or that cannot be told.
    pub(super) fn any(&mut self) -> bool {
        let Some(watch) = &self.watch else { return true };
        let mut buffer = [MaybeUninit::uninit(); 1024];
        let mut reader = Reader::new(watch, &mut buffer);
        while let Ok(event) = reader.next() {
            if event.events().contains(ReadFlags::OPEN) {
                self.n_open += 1;
            } else {
                self.n_open = self.n_open.saturating_sub(1);
            }
        }
        self.n_open > 0
    }
}

fn watched(path: &Path) -> io::Result<OwnedFd> {
    let watch = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
    let closed = WatchFlags::CLOSE_WRITE | WatchFlags::CLOSE_NOWRITE;
    inotify::add_watch(&watch, path, WatchFlags::OPEN | closed)?;
    Ok(watch)
}
