//! From the files of a recording to its streams: what each file is, and what is read from it.

use std::io::Read;
use std::path::{Path, PathBuf};

use devices::Quantity;
use mcap::MAGIC;

use crate::columns::{ChannelColumn, Columns, TimeColumn};
use crate::csv_file::open;
use crate::csv_stream::{CsvStream, TimeBase};
use crate::ending;
use crate::error::ReplayError;
use crate::live_stream::{LiveStream, is_live};
use crate::mcap_inventory::Inventory;
use crate::mcap_stream::{McapStream, MessageTime, Place};
use crate::message::READABLE;
use crate::note::Note;
use crate::stream::Stream;
use crate::topics::{TIME_FIELD, TOPICS};

/// The streams of one recording.
pub(crate) struct Sources {
    pub(crate) streams: Vec<Box<dyn Stream>>,
    /// The channels, in the order of [`Quantity::ALL`].
    pub(crate) quantities: Vec<Quantity>,
    /// What our own recordings say about their ends.
    pub(crate) notes: Vec<Note>,
    /// Log time [ns] of time zero, where foreign MCAP files give one.
    pub(crate) zero_log_time_ns: u64,
}

/// Opens every file of a recording.
pub(crate) fn open_streams(
    recording: &str,
    files: &[(Option<Quantity>, PathBuf)],
    columns: &Columns,
) -> Result<Sources, ReplayError> {
    if files.is_empty() {
        return Err(ReplayError::NoFiles { recording: recording.to_owned() });
    }
    let mut inventories = Vec::new();
    for (_, path) in files {
        inventories.push(if is_mcap(path)? { Some(Inventory::read(path)?) } else { None });
    }
    // Files of one recording share their clock, so the earliest message of all is time zero.
    let foreign = inventories.iter().flatten().filter(|inventory| !inventory.ours);
    let zero_log_time_ns = foreign.filter_map(|inventory| inventory.first_log_time_ns).min();
    let zero_log_time_ns = zero_log_time_ns.unwrap_or(0);
    let endings = files
        .iter()
        .zip(&inventories)
        .filter_map(|((_, path), inventory)| ending::note(path, &inventory.as_ref()?.metadata));
    let notes = endings.collect();
    let mut sources =
        Sources { streams: Vec::new(), quantities: Vec::new(), notes, zero_log_time_ns };
    for ((only, path), inventory) in files.iter().zip(&inventories) {
        match inventory {
            Some(inventory) if inventory.encodings.is_empty() => {
                return Err(ReplayError::NoMessages { path: path.clone() });
            }
            Some(inventory) if inventory.ours => sources.open_ours(path, *only, inventory)?,
            Some(inventory) => sources.open_foreign(path, *only, columns, inventory)?,
            None => sources.open_csv(path, *only, columns)?,
        }
    }
    sources.quantities.sort();
    match sources.quantities.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => {
            Err(ReplayError::ChannelTwice { recording: recording.to_owned(), quantity: pair[0] })
        }
        None => Ok(sources),
    }
}

impl Sources {
    fn open_ours(
        &mut self,
        path: &Path,
        only: Option<Quantity>,
        inventory: &Inventory,
    ) -> Result<(), ReplayError> {
        if only.is_none() && is_live(&inventory.metadata) {
            // Its drivers know of every gap, so that no interval need be judged.
            self.streams.push(Box::new(LiveStream::open(path)?));
            return Ok(());
        }
        for topic in &TOPICS {
            let there = inventory.encodings.contains_key(topic.name);
            if only == Some(topic.quantity) && !there {
                return Err(ReplayError::MissingTopic {
                    path: path.to_owned(),
                    quantity: topic.quantity,
                    topic: topic.name.to_owned(),
                    present: inventory.topics(),
                });
            }
            if there && only.is_none_or(|only| only == topic.quantity) {
                let time =
                    MessageTime::Field { path: TIME_FIELD.to_owned(), seconds_per_unit: 1.0 };
                self.add_topic(
                    path,
                    Place {
                        quantity: topic.quantity,
                        topic: topic.name.to_owned(),
                        field: topic.field.to_owned(),
                        si_per_unit: 1.0,
                        time,
                    },
                )?;
            }
        }
        Ok(())
    }

    fn open_foreign(
        &mut self,
        path: &Path,
        only: Option<Quantity>,
        columns: &Columns,
        inventory: &Inventory,
    ) -> Result<(), ReplayError> {
        for column in channels(path, only, columns)? {
            let quantity = column.quantity;
            let missing = || (path.to_owned(), inventory.topics());
            let Some(topic) = column.topic.clone() else {
                let (path, present) = missing();
                return Err(ReplayError::NoTopic { path, quantity, present });
            };
            match inventory.encodings.get(&topic) {
                Some(encoding) if READABLE.contains(&encoding.as_str()) => {}
                Some(encoding) => {
                    let (path, encoding) = (path.to_owned(), encoding.clone());
                    return Err(ReplayError::Encoding { path, topic, encoding });
                }
                None => {
                    let (path, present) = missing();
                    return Err(ReplayError::MissingTopic { path, quantity, topic, present });
                }
            }
            let time = match column.time.as_ref().or(columns.time.as_ref()) {
                Some(time) => MessageTime::Field {
                    path: time.column.clone(),
                    seconds_per_unit: time.seconds_per_unit,
                },
                None => MessageTime::LogTime { first_ns: self.zero_log_time_ns },
            };
            let (field, si_per_unit) = (column.column.clone(), column.si_per_unit);
            self.add_topic(path, Place { quantity, topic, field, si_per_unit, time })?;
        }
        Ok(())
    }

    fn add_topic(&mut self, path: &Path, place: Place) -> Result<(), ReplayError> {
        self.quantities.push(place.quantity);
        self.streams.push(Box::new(McapStream::open(path, place)?));
        Ok(())
    }

    /// Opens a table once for each time base in it, so that no channel waits for another in memory.
    fn open_csv(
        &mut self,
        path: &Path,
        only: Option<Quantity>,
        columns: &Columns,
    ) -> Result<(), ReplayError> {
        let channels = channels(path, only, columns)?;
        let mut bases: Vec<(Option<&TimeColumn>, Vec<&ChannelColumn>)> = Vec::new();
        for channel in &channels {
            let time = channel.time.as_ref().or(columns.time.as_ref());
            match bases.iter_mut().find(|(base, _)| *base == time) {
                Some((_, members)) => members.push(*channel),
                None => bases.push((time, vec![*channel])),
            }
            self.quantities.push(channel.quantity);
        }
        for (time, members) in bases {
            let base = match (time, columns.sample_rate_hz) {
                (Some(time), _) => TimeBase::Column(time),
                (None, Some(rate_hz)) if rate_hz.is_finite() && rate_hz > 0.0 => {
                    TimeBase::Rate(rate_hz)
                }
                (None, Some(rate_hz)) => return Err(ReplayError::SampleRate { rate_hz }),
                (None, None) => return Err(ReplayError::NoTimeBase { path: path.to_owned() }),
            };
            self.streams.push(Box::new(CsvStream::open(path, base, &members)?));
        }
        Ok(())
    }
}

/// The channels to read from a file, in the order of [`Quantity::ALL`].
fn channels<'a>(
    path: &Path,
    only: Option<Quantity>,
    columns: &'a Columns,
) -> Result<Vec<&'a ChannelColumn>, ReplayError> {
    let wanted = |channel: &&ChannelColumn| only.is_none_or(|only| only == channel.quantity);
    let mut channels: Vec<_> = columns.channels.iter().filter(wanted).collect();
    channels.sort_by_key(|channel| channel.quantity);
    match (channels.is_empty(), only) {
        (false, _) => Ok(channels),
        (true, Some(quantity)) => {
            Err(ReplayError::MissingChannel { path: path.to_owned(), quantity })
        }
        (true, None) => Err(ReplayError::NoChannels { path: path.to_owned() }),
    }
}

/// Whether a file is MCAP by its first bytes; one named `.mcap` must be.
fn is_mcap(path: &Path) -> Result<bool, ReplayError> {
    let mut start = Vec::new();
    let read = open(path)?.take(MAGIC.len() as u64).read_to_end(&mut start);
    read.map_err(|source| ReplayError::Read { path: path.to_owned(), source })?;
    if start.is_empty() {
        return Err(ReplayError::Empty { path: path.to_owned() });
    }
    let named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"));
    match start == MAGIC {
        false if named => Err(ReplayError::NotMcap { path: path.to_owned() }),
        mcap => Ok(mcap),
    }
}
