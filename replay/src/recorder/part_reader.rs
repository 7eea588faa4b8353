//! Reads a part file group by group, past whatever a crash or a disk has spoilt.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

use mcap::{MAGIC, McapError};

use super::part_bytes::{
    GROUP_HEADER_BYTES, GROUP_OPCODE, GROUP_START, PREFIX_BYTES, checksum, group_header, preamble,
};
use crate::error::ReplayError;

/// Longest group read [bytes]; more is a broken length.
const GROUP_BYTES_MAX: u32 = 1 << 28;
/// What is looked through at once in search of the next good group [bytes].
const WINDOW_BYTES: usize = 1 << 16;

/// What of a part file could not be read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Spoilt {
    /// Bytes at the end that are no whole group.
    pub(crate) torn_bytes: u64,
    /// Stretches before the end, each of one or more groups.
    pub(crate) stretches: u64,
    /// Bytes in these stretches.
    pub(crate) stretch_bytes: u64,
}

/// The records of a part file.
pub(crate) struct PartReader<'a> {
    path: PathBuf,
    file: &'a File,
    length: u64,
    /// Byte after the current group.
    offset: u64,
    group: Vec<u8>,
    /// Where the next record stands in the group.
    at: usize,
    spoilt: Spoilt,
}

impl<'a> PartReader<'a> {
    /// Reads a part file from its beginning, wherever the handle stands.
    pub(crate) fn new(path: &Path, file: &'a File) -> Result<Self, ReplayError> {
        let read_error = |source| ReplayError::Read { path: path.to_owned(), source };
        let length = file.metadata().map_err(read_error)?.len();
        let mut reader = Self {
            path: path.to_owned(),
            file,
            length,
            offset: 0,
            group: Vec::new(),
            at: 0,
            spoilt: Spoilt::default(),
        };
        match reader.find_group(MAGIC.len() as u64)? {
            Some(first) => reader.offset = first,
            None => reader.offset = reader.end_of_header()?,
        }
        Ok(reader)
    }

    /// The next record's opcode and body; none at the end.
    pub(crate) fn next(&mut self) -> Result<Option<(u8, &[u8])>, ReplayError> {
        while self.at == self.group.len() {
            if !self.next_group()? {
                return Ok(None);
            }
        }
        let record = &self.group[self.at..];
        let length = record.first_chunk::<PREFIX_BYTES>().map(|prefix| {
            u64::from_le_bytes(std::array::from_fn(|index| prefix[1 + index])) as usize
        });
        let body = length.and_then(|length| record.get(PREFIX_BYTES..)?.get(..length));
        let Some(body) = body else {
            // The checksum was right, so this was written so: no part of ours.
            return Err(self.damaged(McapError::UnexpectedEof));
        };
        self.at += PREFIX_BYTES + body.len();
        Ok(Some((record[0], body)))
    }

    /// What could not be read so far.
    pub(crate) fn spoilt(&self) -> Spoilt {
        self.spoilt
    }

    /// The error of a record that cannot be understood.
    pub(crate) fn damaged(&self, source: McapError) -> ReplayError {
        let offset = self.offset - (self.group.len() - self.at.min(self.group.len())) as u64;
        ReplayError::Damaged { path: self.path.clone(), offset, source: source.into() }
    }

    /// Where the first group would begin in a file that has none.
    ///
    /// # Errors
    /// [`ReplayError::NotMcap`] and [`ReplayError::NotPart`] when no recorder of ours can have left
    /// the file so: what is taken for an empty part is removed, so this must be certain.
    fn end_of_header(&self) -> Result<u64, ReplayError> {
        let path = || self.path.clone();
        let ours = preamble();
        let start = self.bytes(0, ours.len())?;
        if ours.starts_with(&start) && start.len() < ours.len() {
            return Ok(self.length);
        }
        if !start.starts_with(MAGIC) {
            return Err(ReplayError::NotMcap { path: path() });
        }
        // A power cut may leave zeros where the first group was to be; anything else is foreign.
        let next = self.bytes(ours.len() as u64, 1)?;
        let is_ours = start == ours && matches!(next[..], [] | [0 | GROUP_OPCODE]);
        if is_ours { Ok(ours.len() as u64) } else { Err(ReplayError::NotPart { path: path() }) }
    }

    /// Reads the next group whose checksum is right.
    fn next_group(&mut self) -> Result<bool, ReplayError> {
        self.at = 0;
        let expected = self.offset;
        let mut start = Some(expected);
        while let Some(at) = start {
            if let Some(next) = self.read_group(at)? {
                if at > expected {
                    self.spoilt.stretches += 1;
                    self.spoilt.stretch_bytes += at - expected;
                }
                self.offset = next;
                return Ok(true);
            }
            start = self.find_group(at + 1)?;
        }
        self.group.clear();
        self.spoilt.torn_bytes += self.length - expected;
        self.offset = self.length;
        Ok(false)
    }

    /// Reads the group at an offset, and gives the offset after it when its checksum is right.
    fn read_group(&mut self, at: u64) -> Result<Option<u64>, ReplayError> {
        let header = self.bytes(at, GROUP_HEADER_BYTES)?;
        let Some((number, length, sum)) = header.first_chunk().and_then(group_header) else {
            return Ok(None);
        };
        let start = at + GROUP_HEADER_BYTES as u64;
        let end = start + u64::from(length);
        if length > GROUP_BYTES_MAX || end > self.length {
            return Ok(None);
        }
        self.group.resize(length as usize, 0);
        let read = self.file.read_exact_at(&mut self.group, start);
        read.map_err(|source| self.read_error(source))?;
        Ok((checksum(number, &self.group) == sum).then_some(end))
    }

    /// Where, from an offset on, something stands that looks like a group.
    fn find_group(&self, from: u64) -> Result<Option<u64>, ReplayError> {
        let mut at = from;
        while at + GROUP_HEADER_BYTES as u64 <= self.length {
            let window = self.bytes(at, WINDOW_BYTES)?;
            let found = window.windows(GROUP_START.len()).position(|bytes| bytes == GROUP_START);
            if let Some(found) = found {
                return Ok(Some(at + found as u64));
            }
            // A group that begins at the end of the window is seen whole in the next.
            at += (WINDOW_BYTES - GROUP_START.len() + 1) as u64;
        }
        Ok(None)
    }

    /// As many bytes at an offset as the file has there.
    fn bytes(&self, at: u64, count: usize) -> Result<Vec<u8>, ReplayError> {
        let count = (count as u64).min(self.length.saturating_sub(at)) as usize;
        let mut bytes = vec![0; count];
        let read = self.file.read_exact_at(&mut bytes, at);
        read.map(|()| bytes).map_err(|source| self.read_error(source))
    }

    fn read_error(&self, source: io::Error) -> ReplayError {
        ReplayError::Read { path: self.path.clone(), source }
    }
}
