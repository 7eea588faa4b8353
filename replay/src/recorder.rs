//! Writes samples to an MCAP file that other programs open and plot.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use devices::{Quantity, Sample};
use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, McapError, WriteOptions, Writer};

use crate::error::ReplayError;
use crate::topics::{ENCODING, METADATA, PROFILE, TOPICS};

/// Uncompressed size at which a chunk is closed [bytes]; what a tear in it can lose.
const CHUNK_BYTES: u64 = 256 * 1024;

/// Where a recording comes from, kept in its metadata.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Provenance {
    /// The campaign file's text.
    pub campaign_text: String,
    /// What the samples were taken from: files, instruments.
    pub source: String,
    /// Log time [ns] at which the recording's own time base reads zero.
    pub zero_log_time_ns: u64,
}

/// Writes one recording: samples in time order, then [`Recorder::finish`].
///
/// The file is written as `NAME.part` and gets its name when it is whole. A recorder that is
/// dropped unfinished leaves the part behind.
pub struct Recorder {
    target: PathBuf,
    part: PathBuf,
    writer: Writer<BufWriter<File>>,
    zero_log_time_ns: u64,
    channels: [Option<Channel>; TOPICS.len()],
    message: Vec<u8>,
}

struct Channel {
    id: u16,
    samples: u64,
    last_s: f64,
}

impl Recorder {
    /// Starts a recording that will be `target`.
    ///
    /// # Errors
    /// [`ReplayError::Exists`] when `target` or its part exists, [`ReplayError::Write`].
    pub fn create(target: &Path, provenance: &Provenance) -> Result<Self, ReplayError> {
        refuse_existing(target)?;
        let mut part = OsString::from(target);
        part.push(".part");
        let part = PathBuf::from(part);
        refuse_existing(&part)?;
        let file = OpenOptions::new().write(true).create_new(true).open(&part);
        let file = file.map_err(|source| write_error(&part, source.into()))?;
        let options = WriteOptions::new()
            .profile(PROFILE)
            .library(concat!("rolltank ", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            .compression_threads(0)
            .chunk_size(Some(CHUNK_BYTES));
        let writer = options.create(BufWriter::new(file)).and_then(|mut writer| {
            writer.write_metadata(&metadata(provenance))?;
            Ok(writer)
        });
        Ok(Self {
            target: target.to_owned(),
            writer: writer.map_err(|source| write_error(&part, source))?,
            part,
            zero_log_time_ns: provenance.zero_log_time_ns,
            channels: [const { None }; TOPICS.len()],
            message: Vec::new(),
        })
    }

    /// Appends one sample; the samples of a channel come in time order.
    ///
    /// # Errors
    /// [`ReplayError::Unrecordable`] when a number is not finite or the time has no log time,
    /// [`ReplayError::TimeBackwards`], [`ReplayError::Write`].
    pub fn push(&mut self, sample: &Sample) -> Result<(), ReplayError> {
        let log_time = self.log_time_ns(sample)?;
        let slot = sample.quantity as usize;
        let channel = self.channel(slot)?;
        if sample.time_s < channel.last_s {
            let (time_s, previous_s) = (sample.time_s, channel.last_s);
            let place = format!("channel {}", sample.quantity.name());
            let path = self.target.clone();
            return Err(ReplayError::TimeBackwards { path, place, time_s, previous_s });
        }
        let header = MessageHeader {
            channel_id: channel.id,
            sequence: channel.samples as u32,
            log_time,
            publish_time: log_time,
        };
        channel.samples += 1;
        channel.last_s = sample.time_s;
        TOPICS[slot].write_message(sample, &mut self.message);
        let written = self.writer.write_to_known_channel(&header, &self.message);
        written.map_err(|source| write_error(&self.part, source))
    }

    /// Completes the file, has the disk keep it, gives it its name; the samples of each channel.
    ///
    /// # Errors
    /// [`ReplayError::Write`], [`ReplayError::Exists`] when the name was taken in the meantime.
    pub fn finish(mut self) -> Result<Vec<(Quantity, u64)>, ReplayError> {
        let part = self.part.clone();
        let failed = |source: std::io::Error| write_error(&part, source.into());
        self.writer.finish().map_err(|source| write_error(&self.part, source))?;
        let file = self.writer.into_inner().into_inner();
        file.map_err(|error| failed(error.into_error()))?.sync_all().map_err(failed)?;
        refuse_existing(&self.target)?;
        fs::rename(&self.part, &self.target).map_err(failed)?;
        let samples = Quantity::ALL.into_iter().zip(&self.channels);
        let samples = samples.filter_map(|(quantity, channel)| {
            channel.as_ref().map(|channel| (quantity, channel.samples))
        });
        Ok(samples.collect())
    }

    /// Gives the recording up and removes its part.
    ///
    /// # Errors
    /// [`ReplayError::Write`] when the part cannot be removed.
    pub fn abandon(self) -> Result<(), ReplayError> {
        let part = self.part;
        drop(self.writer);
        fs::remove_file(&part).map_err(|source| write_error(&part, source.into()))
    }

    /// The channel of a topic, added to the file with its first sample.
    fn channel(&mut self, slot: usize) -> Result<&mut Channel, ReplayError> {
        if self.channels[slot].is_none() {
            let topic = &TOPICS[slot];
            let schema =
                self.writer.add_schema(&topic.schema_name(), "jsonschema", &topic.schema());
            let id = schema.and_then(|schema| {
                self.writer.add_channel(schema, topic.name, ENCODING, &BTreeMap::new())
            });
            let id = id.map_err(|source| write_error(&self.part, source))?;
            self.channels[slot] = Some(Channel { id, samples: 0, last_s: f64::NEG_INFINITY });
        }
        Ok(self.channels[slot].as_mut().expect("the channel was added just above"))
    }

    fn log_time_ns(&self, sample: &Sample) -> Result<u64, ReplayError> {
        let Sample { quantity, time_s, value } = *sample;
        let refused = |limit| ReplayError::Unrecordable { quantity, value, time_s, limit };
        if !value.is_finite() || !time_s.is_finite() {
            return Err(refused("value and time must be finite"));
        }
        let log_time_ns = (time_s * 1e9).round() as i128 + i128::from(self.zero_log_time_ns);
        u64::try_from(log_time_ns)
            .map_err(|_| refused("its log time must be 0 to 18.4e9 s, counted from time zero"))
    }
}

fn metadata(provenance: &Provenance) -> Metadata {
    let Provenance { campaign_text, source, zero_log_time_ns } = provenance;
    let entries = [
        ("campaign", campaign_text.clone()),
        ("source", source.clone()),
        ("zero_log_time_ns", zero_log_time_ns.to_string()),
    ];
    let metadata = entries.map(|(key, text)| (key.to_owned(), text)).into_iter().collect();
    Metadata { name: METADATA.to_owned(), metadata }
}

/// A link that leads nowhere counts as a file that is there.
fn refuse_existing(path: &Path) -> Result<(), ReplayError> {
    match path.symlink_metadata() {
        Ok(_) => Err(ReplayError::Exists { path: path.to_owned() }),
        Err(_) => Ok(()),
    }
}

fn write_error(path: &Path, source: McapError) -> ReplayError {
    ReplayError::Write { path: path.to_owned(), source: source.into() }
}
