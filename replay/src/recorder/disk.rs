//! The file system as the recorder needs it, so that a test can fill it.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use rustix::fs::{CWD, RenameFlags, renameat_with, statvfs};
use rustix::io::Errno;

/// What the recorder asks of a file system beyond opening files.
pub trait Disk: Send {
    /// Bytes that may still be written to the file system of a folder.
    ///
    /// # Errors
    /// What the system said.
    fn free_bytes(&mut self, folder: &Path) -> io::Result<u64>;

    /// Appends all of the bytes to a file; after an error any part of them may be there.
    ///
    /// # Errors
    /// What the system said; a full disk is [`io::ErrorKind::StorageFull`].
    fn append(&mut self, file: &mut File, bytes: &[u8]) -> io::Result<()>;
}

/// The real file system.
#[derive(Debug, Clone, Copy, Default)]
pub struct LocalDisk;

impl Disk for LocalDisk {
    fn free_bytes(&mut self, folder: &Path) -> io::Result<u64> {
        let told = statvfs(folder)?;
        Ok(told.f_bavail.saturating_mul(told.f_frsize))
    }

    fn append(&mut self, file: &mut File, bytes: &[u8]) -> io::Result<()> {
        file.write_all(bytes)
    }
}

/// The folder that a file lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Gives a file another name in its folder unless that is taken, and has the disk keep it.
pub(crate) fn rename_onto_nothing(from: &Path, to: &Path) -> io::Result<()> {
    match renameat_with(CWD, from, CWD, to, RenameFlags::NOREPLACE) {
        // Some network file systems know no such rename; a second name is refused just as well
        // when it is taken.
        Err(Errno::INVAL | Errno::NOSYS) => {
            fs::hard_link(from, to)?;
            fs::remove_file(from)?;
        }
        renamed => renamed?,
    }
    keep_names(to)
}

/// Has the disk keep the names in the folder of a file.
pub(crate) fn keep_names(path: &Path) -> io::Result<()> {
    File::open(folder_of(path))?.sync_all()
}
