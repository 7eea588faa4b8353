//! The part file while it grows: groups of records appended whole, or taken back.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::disk::{Disk, keep_names};
use super::part_bytes::{GROUP_HEADER_BYTES, preamble, seal};
use super::syncer::Syncer;
use crate::error::ReplayError;

/// A part file that is written to.
pub(crate) struct Journal {
    pub(crate) path: PathBuf,
    pub(crate) disk: Box<dyn Disk>,
    /// Locked for as long as it is open, so that nobody recovers what is still being recorded.
    file: File,
    syncer: Option<Syncer>,
    /// The group being filled, behind room for its header.
    group: Vec<u8>,
    groups: u32,
    written_bytes: u64,
}

impl Journal {
    /// Makes the part file, with nothing in it but what tells a program its kind.
    pub(crate) fn create(path: &Path, mut disk: Box<dyn Disk>) -> Result<Self, ReplayError> {
        let mut options = OpenOptions::new();
        let opened = options.read(true).append(true).create_new(true).open(path);
        let mut file = opened.map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => ReplayError::Exists { path: path.to_owned() },
            _ => ReplayError::written(path, 0, source),
        })?;
        lock(&file, path)?;
        let start = preamble();
        if let Err(source) = disk.append(&mut file, &start) {
            // A part without its beginning is nobody's.
            drop(fs::remove_file(path));
            return Err(ReplayError::written(path, 0, source));
        }
        let written_bytes = start.len() as u64;
        let (path, group) = (path.to_owned(), vec![0; GROUP_HEADER_BYTES]);
        Ok(Self { path, disk, file, syncer: None, group, groups: 0, written_bytes })
    }

    /// The group being filled; records are appended to it.
    pub(crate) fn group(&mut self) -> &mut Vec<u8> {
        &mut self.group
    }

    /// Bytes of records not yet handed to the system.
    pub(crate) fn waiting_bytes(&self) -> usize {
        self.group.len() - GROUP_HEADER_BYTES
    }

    /// Bytes handed to the system.
    pub(crate) fn written_bytes(&self) -> u64 {
        self.written_bytes
    }

    /// Hands the group to the system, where it outlives this program.
    ///
    /// When there is no room, the file is cut back to the group before, and the group kept: the
    /// next call tries it again.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        if self.waiting_bytes() == 0 {
            return Ok(());
        }
        seal(&mut self.group, self.groups);
        if let Err(error) = self.disk.append(&mut self.file, &self.group) {
            // Should this fail too, the half group is passed over when the file is read.
            drop(self.file.set_len(self.written_bytes));
            return Err(error);
        }
        self.written_bytes += self.group.len() as u64;
        self.groups = self.groups.wrapping_add(1);
        self.group.truncate(GROUP_HEADER_BYTES);
        Ok(())
    }

    /// Asks for the disk to keep what was handed to the system, and tells of an earlier failure.
    pub(crate) fn ask_to_keep(&mut self) -> io::Result<()> {
        let syncer = match self.syncer.take() {
            Some(syncer) => syncer,
            None => Syncer::start(&self.file)?,
        };
        let syncer = self.syncer.insert(syncer);
        syncer.ask();
        syncer.failure().map_or(Ok(()), Err)
    }

    /// Waits until the disk keeps what was handed to the system, and the file's name.
    pub(crate) fn keep(&mut self) -> io::Result<()> {
        let stopped = self.syncer.take().map_or(Ok(()), Syncer::stop);
        stopped.and_then(|()| self.file.sync_all()).and_then(|()| keep_names(&self.path))
    }

    /// Ends the writing; the file, still locked, and what it was written through.
    pub(crate) fn into_parts(self) -> (PathBuf, File, Box<dyn Disk>) {
        (self.path, self.file, self.disk)
    }
}

/// Opens a part file that some recorder left behind, for us alone.
pub(crate) fn open_orphan(path: &Path) -> Result<File, ReplayError> {
    // For writing, as network file systems lock nothing else.
    let opened = OpenOptions::new().read(true).append(true).open(path);
    let file = opened.map_err(|source| ReplayError::Open { path: path.to_owned(), source })?;
    lock(&file, path)?;
    Ok(file)
}

fn lock(file: &File, path: &Path) -> Result<(), ReplayError> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(ReplayError::InUse { path: path.to_owned() }),
        // Some network file systems lock nothing; there the names have to keep recorders apart.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(source)) => Err(ReplayError::write(path, source)),
    }
}
