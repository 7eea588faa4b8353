//! Copies the records of a part file into an indexed, compressed MCAP file with checksums.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use mcap::records::{Channel, MessageHeader, Metadata, Record as McapRecord};
use mcap::{Compression, McapError, WriteOptions, Writer, parse_record};

use super::closed::Stop;
use super::digest::{Contents, Digest};
use super::disk::Disk;
use super::open_run::OpenRuns;
use super::part_bytes::LIBRARY;
use super::part_reader::PartReader;
use super::survey::Survey;
use crate::documents::{DOCUMENTS, RUN_STOP, write_document};
use crate::error::ReplayError;
use crate::record::Record;
use crate::topics::{ENCODING, METADATA, PROFILE};

/// Uncompressed size at which a chunk is closed [bytes].
const CHUNK_BYTES: u64 = 256 * 1024;

/// Writes the file `into`, which must not exist, and has the disk keep it; what it is to hold.
pub(crate) fn convert(
    part: &Path,
    file: &File,
    survey: &Survey,
    stop: &Stop,
    disk: &mut dyn Disk,
    into: &Path,
) -> Result<Contents, ReplayError> {
    let failed = |source: io::Error| ReplayError::written(into, 0, source);
    let created = OpenOptions::new().write(true).create_new(true).open(into).map_err(failed)?;
    let output = BufWriter::with_capacity(1 << 16, Through { disk, file: created });
    let options = WriteOptions::new()
        .profile(PROFILE)
        .library(LIBRARY)
        .compression(Some(Compression::Zstd))
        .compression_threads(0)
        .chunk_size(Some(CHUNK_BYTES));
    let mcap_failed = |source: McapError| match source {
        McapError::Io(source) => failed(source),
        source => ReplayError::Write { path: into.to_owned(), source: source.into() },
    };
    let mut copier = Copier {
        writer: options.create(output).map_err(mcap_failed)?,
        schemas: BTreeMap::new(),
        channels: BTreeMap::new(),
        digest: Digest::default(),
    };
    let metadata = Metadata { name: METADATA.to_owned(), metadata: entries(survey, stop) };
    copier.writer.write_metadata(&metadata).map_err(mcap_failed)?;
    let zero_ns = survey.zero_log_time_ns();
    let mut open_runs = OpenRuns::new(&survey.open_runs, zero_ns);
    let mut reader = PartReader::new(part, file)?;
    while let Some((opcode, body)) = reader.next()? {
        match parse_record(opcode, body) {
            Ok(McapRecord::Schema { header, data }) => {
                copier.schemas.insert(header.id, (header.name, data.into_owned()));
            }
            Ok(McapRecord::Channel(channel)) => {
                copier.channels.insert(channel.id, Copied { channel, id: None });
            }
            Ok(McapRecord::Message { header, data }) => {
                copier.message(&header, &data).map_err(mcap_failed)?;
                if let Some(copied) = copier.channels.get(&header.channel_id) {
                    open_runs.count(&copied.channel.topic, header.log_time, &data);
                }
            }
            Ok(_) => {}
            Err(error) => return Err(reader.damaged(error)),
        }
    }
    let end_ns = i128::from(survey.last_log_time_ns) - i128::from(zero_ns);
    let end_s = end_ns as f64 / 1e9;
    for stop in open_runs.stops(end_s, &stop.exit) {
        let stop = Record::RunStop(stop);
        copier.stop_run(&stop, survey.last_log_time_ns).map_err(mcap_failed)?;
    }
    copier.writer.finish().map_err(mcap_failed)?;
    let output = copier.writer.into_inner().into_inner();
    let output = output.map_err(|error| failed(error.into_error()))?;
    output.file.sync_all().map_err(failed)?;
    Ok(copier.digest.contents())
}

/// All that the metadata of a finished file tells.
fn entries(survey: &Survey, stop: &Stop) -> BTreeMap<String, String> {
    let mut entries = survey.provenance.clone();
    entries.extend(stop.exit.entries(stop.unrecorded));
    let numbers = [
        ("messages", survey.messages + survey.open_runs.len() as u64),
        ("torn_bytes", survey.spoilt.torn_bytes),
        ("spoilt_bytes", survey.spoilt.stretch_bytes),
        ("unreadable", survey.unreadable),
    ];
    entries.extend(numbers.map(|(key, number)| (key.to_owned(), number.to_string())));
    entries
}

struct Copier<'d> {
    writer: Writer<BufWriter<Through<'d>>>,
    schemas: BTreeMap<u16, (String, Vec<u8>)>,
    channels: BTreeMap<u16, Copied>,
    digest: Digest,
}

struct Copied {
    channel: Channel,
    /// Its id in the finished file, which holds only channels that have messages.
    id: Option<u16>,
}

impl Copier<'_> {
    /// Copies a message; one whose channel is unknown was counted by the survey.
    fn message(&mut self, header: &MessageHeader, data: &[u8]) -> Result<(), McapError> {
        let Some(copied) = self.channels.get_mut(&header.channel_id) else { return Ok(()) };
        let id = if let Some(id) = copied.id {
            id
        } else {
            let (topic, schema_id) = (&copied.channel.topic, copied.channel.schema_id);
            let schema = self.schemas.get(&schema_id);
            let schema = schema.map_or(Ok(0), |(name, definition)| {
                self.writer.add_schema(name, "jsonschema", definition)
            })?;
            let id = self.writer.add_channel(schema, topic, ENCODING, &BTreeMap::new())?;
            self.digest.channel(id, topic);
            *copied.id.insert(id)
        };
        let header = MessageHeader { channel_id: id, ..*header };
        self.digest.message(&header, data);
        self.writer.write_to_known_channel(&header, data)
    }

    /// Adds the end of a run that nobody had ended.
    fn stop_run(&mut self, stop: &Record, log_time: u64) -> Result<(), McapError> {
        let document = &DOCUMENTS[RUN_STOP];
        let schema = document.schema();
        let schema = self.writer.add_schema(&document.schema_name(), "jsonschema", &schema)?;
        let channel_id =
            self.writer.add_channel(schema, document.topic, ENCODING, &BTreeMap::new())?;
        self.digest.channel(channel_id, document.topic);
        let mut message = Vec::new();
        write_document(stop, &mut message);
        // Its own recorder gave it no number.
        let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
        self.digest.message(&header, &message);
        self.writer.write_to_known_channel(&header, &message)
    }
}

/// A file that is written through the recorder's disk.
struct Through<'d> {
    disk: &'d mut dyn Disk,
    file: File,
}

impl Write for Through<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.disk.append(&mut self.file, bytes).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Through<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}
