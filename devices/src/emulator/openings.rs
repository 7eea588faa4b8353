//! Whether any program has a file open, as the system tells it.

use std::fs;
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

use rustix::fs::inotify::{self, CreateFlags, ReadFlags, Reader, WatchFlags};
use rustix::io;

/// Times that the system is asked again after an opening that it did not list yet.
const ASKED_AGAIN: u8 = 3;

/// Knows whether a file is open from now on.
///
/// Openings cannot be counted: the system makes one event of two that are alike and follow each
/// other (inotify(7)). So an opening is believed, and after a closing the system is asked who still
/// has the file.
pub(super) struct Openings {
    path: PathBuf,
    /// None where the system watches no more files for this user.
    watch: Option<OwnedFd>,
    is_open: bool,
    /// How often it is asked yet who has opened the file: its descriptor is listed a little later
    /// than the opening is told.
    asks_again: u8,
    /// Openings of this process that are not counted.
    n_own: usize,
}

impl Openings {
    /// Watches a file; who has it open already in this process is not counted.
    pub(super) fn of(path: &Path) -> Self {
        let n_own = n_open("self", path);
        Self {
            path: path.to_owned(),
            watch: watched(path).ok(),
            is_open: false,
            asks_again: 0,
            n_own,
        }
    }

    /// Whether somebody has it open, or that cannot be told.
    pub(super) fn any(&mut self) -> bool {
        let Some(watch) = &self.watch else { return true };
        let mut buffer = [MaybeUninit::uninit(); 1024];
        let mut reader = Reader::new(watch, &mut buffer);
        let mut was_closed = false;
        while let Ok(event) = reader.next() {
            if event.events().contains(ReadFlags::OPEN) {
                (self.is_open, self.asks_again) = (true, ASKED_AGAIN);
            } else {
                was_closed = true;
            }
        }
        let is_unsure = !self.is_open && self.asks_again > 0;
        if was_closed || is_unsure {
            self.asks_again = self.asks_again.saturating_sub(1);
            self.is_open = self.is_listed();
        }
        self.is_open
    }

    /// Whether a process has it open, apart from what of this one is not counted.
    fn is_listed(&self) -> bool {
        let own = std::process::id().to_string();
        let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
        let mut names = processes.filter_map(|process| process.file_name().into_string().ok());
        names.any(|name| {
            let n_not_counted = if name == own { self.n_own } else { 0 };
            name.bytes().all(|byte| byte.is_ascii_digit())
                && n_open(&name, &self.path) > n_not_counted
        })
    }
}

/// How many descriptors of a process are a file; none where this user may not know.
fn n_open(process: &str, path: &Path) -> usize {
    let descriptors = fs::read_dir(format!("/proc/{process}/fd")).into_iter().flatten().flatten();
    let is_it = |entry: &fs::DirEntry| fs::read_link(entry.path()).is_ok_and(|link| link == path);
    descriptors.filter(is_it).count()
}

fn watched(path: &Path) -> io::Result<OwnedFd> {
    let watch = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
    let closed = WatchFlags::CLOSE_WRITE | WatchFlags::CLOSE_NOWRITE;
    inotify::add_watch(&watch, path, WatchFlags::OPEN | closed)?;
    Ok(watch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;

    #[test]
    fn of_two_programs_at_a_port_one_may_leave() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().canonicalize().expect("it is there").join("port");
        let own = File::create(&path).expect("the disk has room");
        let mut openings = Openings::of(&path);
        assert!(!openings.any());
        // Both openings wait to be told, and are told as one.
        let [first, second] = [(); 2].map(|()| File::open(&path).expect("it can be read"));
        assert!(openings.any());
        drop(first);
        assert!(openings.any(), "the second still has it open");
        drop(second);
        assert!(!openings.any());
        drop(own);
    }
}
