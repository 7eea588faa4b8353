//! The records of an MCAP file in file order, read linearly up to its end or its tear.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use mcap::records::op;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError};

use crate::csv_file::open;
use crate::error::ReplayError;

/// Longest record read [bytes]; more is no roll test but a broken length.
const RECORD_BYTES_MAX: u64 = 1 << 26;
/// Largest chunk held in memory to check it before its records are given [bytes]. The records of a
/// larger chunk, and of one that is torn, are given as they come.
const CHECKED_FIRST_BYTES_MAX: u64 = 1 << 24;
/// Opcode and length before every record [bytes].
const PREFIX_BYTES: u64 = 9;
/// Bytes of a chunk's header up to the name of its compression.
const CHUNK_START_BYTES: usize = 32;
/// Footer record and closing magic at the end of a whole file [bytes].
const FOOTER_BYTES: u64 = PREFIX_BYTES + 20 + MAGIC.len() as u64;

/// Records of an MCAP file; chunks are unpacked on the way, and nothing is mapped into memory.
pub(crate) struct Records {
    path: PathBuf,
    file: BufReader<File>,
    length: u64,
    /// Byte after the record, or the part of a chunk, read last.
    offset: u64,
    /// Byte at which the record read last begins; its chunk, when it is in one.
    record_start: u64,
    /// The compressed chunk being unpacked.
    chunk: Option<Chunk>,
    unpacker: LinearReader,
    /// Whether the unpacker checks a chunk's checksum before it gives any of its records.
    checks_first: bool,
    body: Vec<u8>,
    /// Whether the footer was reached.
    complete: bool,
    torn_at: Option<u64>,
}

struct Chunk {
    start: u64,
    /// Bytes of the chunk record not yet given to the unpacker.
    remaining: u64,
    /// Whether its writer never came to write its lengths.
    open: bool,
    /// Prefix and header, given to the unpacker before the rest.
    header: Vec<u8>,
}

impl Records {
    /// Opens the file behind its magic bytes.
    pub(crate) fn open(path: &Path) -> Result<Self, ReplayError> {
        let file = open(path)?;
        let read_error = |source| ReplayError::Read { path: path.to_owned(), source };
        let length = file.metadata().map_err(read_error)?.len();
        let mut file = BufReader::with_capacity(1 << 16, file);
        let mut magic = Vec::new();
        (&mut file).take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(read_error)?;
        if magic.is_empty() {
            return Err(ReplayError::Empty { path: path.to_owned() });
        }
        if magic != MAGIC {
            return Err(ReplayError::NotMcap { path: path.to_owned() });
        }
        Ok(Self {
            path: path.to_owned(),
            file,
            length,
            offset: MAGIC.len() as u64,
            record_start: MAGIC.len() as u64,
            chunk: None,
            unpacker: unpacker(true),
            checks_first: true,
            body: Vec::new(),
            complete: false,
            torn_at: None,
        })
    }

    /// Moves to the summary section, when the file is whole and has one.
    pub(crate) fn seek_to_summary(&mut self) -> Result<bool, ReplayError> {
        let Some(footer) = self.length.checked_sub(FOOTER_BYTES) else { return Ok(false) };
        let mut bytes = [0; FOOTER_BYTES as usize];
        self.seek(footer)?;
        self.fill(&mut bytes)?;
        let start = u64::from_le_bytes(eight(&bytes, PREFIX_BYTES as usize));
        let whole = bytes[0] == op::FOOTER && bytes.ends_with(MAGIC);
        let there = whole && start >= MAGIC.len() as u64 && start < footer;
        self.seek(if there { start } else { MAGIC.len() as u64 })?;
        Ok(there)
    }

    /// The next record's opcode, records of no use here passed over; see [`Records::body`].
    pub(crate) fn next(&mut self) -> Result<Option<u8>, ReplayError> {
        loop {
            if self.chunk.is_some() {
                if let Some(opcode) = self.next_in_chunk()? {
                    return Ok(Some(opcode));
                }
                continue;
            }
            let start = self.offset;
            self.record_start = start;
            if self.complete {
                return Ok(None);
            }
            if self.torn_at.is_some() || !self.has(PREFIX_BYTES) {
                self.torn_at.get_or_insert(start);
                return Ok(None);
            }
            let mut prefix = [0; PREFIX_BYTES as usize];
            self.fill(&mut prefix)?;
            let (opcode, length) = (prefix[0], u64::from_le_bytes(eight(&prefix, 1)));
            match opcode {
                op::FOOTER => {
                    (self.complete, self.offset) = (true, self.length);
                }
                op::CHUNK => self.start_chunk(&prefix, start, length)?,
                // A computer that loses power can leave a tail of zeros behind.
                0 => self.torn_at = Some(start),
                _ if !self.has(length) => self.torn_at = Some(start),
                // Metadata of any size may be passed over.
                op::METADATA if length > RECORD_BYTES_MAX => self.seek(self.offset + length)?,
                op::METADATA
                | op::HEADER
                | op::SCHEMA
                | op::CHANNEL
                | op::MESSAGE
                | op::STATISTICS => {
                    self.read_body(length)?;
                    return Ok(Some(opcode));
                }
                _ => self.seek(self.offset + length)?,
            }
        }
    }

    /// Body of the current record.
    pub(crate) fn body(&self) -> &[u8] {
        &self.body
    }

    /// Byte at which the file was torn, when it was and reading came that far.
    pub(crate) fn torn_at(&self) -> Option<u64> {
        self.torn_at
    }

    /// Bytes read so far.
    pub(crate) fn bytes_read(&self) -> u64 {
        self.offset
    }

    /// Bytes of the file.
    pub(crate) fn bytes_total(&self) -> u64 {
        self.length
    }

    /// The error of a record that cannot be understood.
    pub(crate) fn damaged(&self, source: McapError) -> ReplayError {
        let (path, offset) = (self.path.clone(), self.record_start);
        ReplayError::Damaged { path, offset, source: source.into() }
    }

    /// Reads a chunk's header and says how its records are to be read.
    fn start_chunk(&mut self, prefix: &[u8], start: u64, length: u64) -> Result<(), ReplayError> {
        let mut header = prefix.to_vec();
        if !self.has(CHUNK_START_BYTES as u64) {
            self.torn_at = Some(start);
            return Ok(());
        }
        header.resize(prefix.len() + CHUNK_START_BYTES, 0);
        self.fill(&mut header[prefix.len()..])?;
        let named = header.len();
        let name_bytes = u32::from_le_bytes(four(&header, named - 4));
        let rest = u64::from(name_bytes) + 8;
        if !self.has(rest) {
            self.torn_at = Some(start);
            return Ok(());
        }
        if name_bytes == 0 {
            // Records of a chunk that is not compressed stand in the file as if there were none;
            // their checksum is not looked at.
            return self.seek(self.offset + rest);
        }
        if name_bytes > 64 {
            return Err(self.damaged(McapError::ChunkTooLarge(length)));
        }
        header.resize(named + rest as usize, 0);
        self.fill(&mut header[named..])?;
        let header_bytes = (header.len() - prefix.len()) as u64;
        let mut remaining = length.checked_sub(header_bytes).ok_or_else(|| {
            self.damaged(McapError::BadChunkLength { header: header_bytes, available: length })
        })?;
        let unpacked_bytes = u64::from_le_bytes(eight(&header, prefix.len() + 16));
        let checks_first = self.has(remaining) && unpacked_bytes <= CHECKED_FIRST_BYTES_MAX;
        if checks_first != self.checks_first {
            (self.unpacker, self.checks_first) = (unpacker(checks_first), checks_first);
        }
        let open = length == u64::MAX;
        if open {
            remaining = self.length - self.offset;
            close(&mut header, remaining);
        }
        self.chunk = Some(Chunk { start, remaining, open, header });
        Ok(())
    }

    /// The next record of the current chunk; none at its end or its tear.
    fn next_in_chunk(&mut self) -> Result<Option<u8>, ReplayError> {
        while let Some(chunk) = &mut self.chunk {
            let wanted = match self.unpacker.next_event() {
                Some(Ok(LinearReadEvent::Record { opcode, data })) => {
                    self.body.clear();
                    self.body.extend_from_slice(data);
                    return Ok(Some(opcode));
                }
                Some(Ok(LinearReadEvent::ReadRequest(wanted))) => wanted,
                // The data of an open chunk just stops.
                Some(Err(_)) if chunk.open && chunk.remaining == 0 => {
                    self.torn_at = Some(chunk.start);
                    0
                }
                Some(Err(error)) => return Err(self.damaged(error)),
                None => 0,
            };
            let read = if wanted == 0 {
                0
            } else if chunk.header.is_empty() {
                let wanted = chunk.remaining.min(wanted as u64) as usize;
                let read = self.file.read(self.unpacker.insert(wanted));
                let read =
                    read.map_err(|source| ReplayError::Read { path: self.path.clone(), source })?;
                chunk.remaining -= read as u64;
                self.offset += read as u64;
                read
            } else {
                let read = chunk.header.len().min(wanted);
                self.unpacker.insert(read).copy_from_slice(&chunk.header[..read]);
                chunk.header.drain(..read);
                read
            };
            if read > 0 {
                self.unpacker.notify_read(read);
            } else {
                if chunk.remaining > 0 {
                    self.torn_at = Some(chunk.start);
                }
                self.chunk = None;
            }
        }
        Ok(None)
    }

    fn read_body(&mut self, length: u64) -> Result<(), ReplayError> {
        if length > RECORD_BYTES_MAX {
            return Err(self.damaged(McapError::ChunkTooLarge(length)));
        }
        let mut body = std::mem::take(&mut self.body);
        body.resize(length as usize, 0);
        let filled = self.fill(&mut body);
        self.body = body;
        filled
    }

    fn has(&self, bytes: u64) -> bool {
        self.length - self.offset >= bytes
    }

    fn fill(&mut self, bytes: &mut [u8]) -> Result<(), ReplayError> {
        self.offset += bytes.len() as u64;
        self.file.read_exact(bytes).map_err(|source| self.read_error(source))
    }

    fn seek(&mut self, offset: u64) -> Result<(), ReplayError> {
        // A relative seek keeps what the buffer already holds.
        let sought = match i64::try_from(i128::from(offset) - i128::from(self.offset)) {
            Ok(distance) => self.file.seek_relative(distance),
            Err(_) => self.file.seek(SeekFrom::Start(offset)).map(drop),
        };
        self.offset = offset;
        sought.map_err(|source| self.read_error(source))
    }

    fn read_error(&self, source: io::Error) -> ReplayError {
        ReplayError::Read { path: self.path.clone(), source }
    }
}

/// An unpacker of chunks that checks their checksum before or while it gives their records.
fn unpacker(checks_first: bool) -> LinearReader {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(RECORD_BYTES_MAX as usize);
    LinearReader::new_with_options(if checks_first {
        options.with_prevalidate_chunk_crcs(true)
    } else {
        options
    })
}

/// Gives the header of a chunk that its writer never closed the sizes of what is in the file.
///
/// An open chunk has lengths of `u64::MAX`; what was flushed of its compressed data can be unpacked
/// all the same. Its checksum is unknown, which MCAP writes as zero.
fn close(header: &mut [u8], remaining: u64) {
    let after_prefix = PREFIX_BYTES as usize;
    let length = (header.len() - after_prefix) as u64 + remaining;
    let last = header.len() - 8;
    header[1..after_prefix].copy_from_slice(&length.to_le_bytes());
    header[after_prefix + 24..after_prefix + 28].fill(0);
    header[last..].copy_from_slice(&remaining.to_le_bytes());
}

fn eight(bytes: &[u8], at: usize) -> [u8; 8] {
    std::array::from_fn(|index| bytes[at + index])
}

fn four(bytes: &[u8], at: usize) -> [u8; 4] {
    std::array::from_fn(|index| bytes[at + index])
}
