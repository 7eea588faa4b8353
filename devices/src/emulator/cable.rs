//! A pseudo-terminal under a name that can vanish, as a cable in its socket.

use std::collections::VecDeque;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{OpenOptionsExt, symlink};
use std::path::{Path, PathBuf};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, ioctl_tiocnxcl, tcgetattr, tcsetattr};

use super::openings::Openings;

/// Bytes that wait for a slow reader; one that takes none of so many is gone.
const WAITING_BYTES_MAX: usize = 4 << 20;

/// A pseudo-terminal and its name.
pub(super) struct Cable {
    path: PathBuf,
    master: OwnedFd,
    /// Held open, since the other end would read errors between two openings of the port.
    slave: File,
    /// Who has the port open.
    openings: Openings,
    /// Sent, and not yet taken by the terminal, which holds some kilobytes.
    waiting: VecDeque<u8>,
}

impl Cable {
    pub(super) fn plug_in(path: &Path) -> io::Result<Self> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        fcntl_setfl(&master, OFlags::RDWR | OFlags::NONBLOCK)?;
        let name = ptsname(&master, Vec::new())?;
        let name = Path::new(OsStr::from_bytes(name.to_bytes())).to_owned();
        let no_control = i32::try_from(OFlags::NOCTTY.bits()).unwrap_or_default();
        let mut open = OpenOptions::new();
        let slave = open.read(true).write(true).custom_flags(no_control).open(&name)?;
        // A terminal that is not raw echoes the instrument's own words back to it.
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        let openings = Openings::of(&name);
        if path.is_symlink() {
            fs::remove_file(path)?;
        }
        symlink(&name, path)?;
        Ok(Self { path: path.to_owned(), master, slave, openings, waiting: VecDeque::new() })
    }

    /// What the host sent.
    pub(super) fn read(&self) -> Vec<u8> {
        let mut bytes = vec![0; 4096];
        let n_bytes = rustix::io::read(&self.master, &mut bytes[..]).unwrap_or(0);
        bytes.truncate(n_bytes);
        bytes
    }

    /// The speed that the host has set the port to [bit/s].
    pub(super) fn baud(&self) -> Option<u32> {
        Some(tcgetattr(&self.slave).ok()?.output_speed())
    }

    /// Takes off the mark of exclusive use that a program leaves when it is killed.
    pub(super) fn release(&self) {
        ioctl_tiocnxcl(&self.slave).ok();
    }

    /// Sends bytes: without a program at the port they are lost, as on a line, and one that is only
    /// slow is waited for.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        if !self.openings.any() {
            self.waiting.clear();
        } else if self.waiting.len() + bytes.len() <= WAITING_BYTES_MAX {
            self.waiting.extend(bytes);
        }
    }

    /// Passes on what the terminal takes of what was sent.
    pub(super) fn pass_on(&mut self) {
        while !self.waiting.is_empty() {
            let (first, _) = self.waiting.as_slices();
            let Ok(n_bytes) = rustix::io::write(&self.master, first) else { return };
            self.waiting.drain(..n_bytes);
        }
    }

    /// Waits at most so long [ns] for bytes from the host, or for room for those that wait.
    pub(super) fn wait(&self, wait_ns: i64) {
        let turn = Timespec { tv_sec: 0, tv_nsec: wait_ns };
        let room = if self.waiting.is_empty() { PollFlags::empty() } else { PollFlags::OUT };
        let mut ready = [PollFd::new(&self.master, PollFlags::IN | room)];
        // Whatever ends the wait, the loop looks at everything again.
        poll(&mut ready, Some(&turn)).ok();
    }
}

impl Drop for Cable {
    fn drop(&mut self) {
        drop(fs::remove_file(&self.path));
    }
}
