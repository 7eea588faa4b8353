//! What can be wrong with a recording, said with its place, its value and its limit.

use std::io;
use std::path::{Path, PathBuf};

use devices::Quantity;

use crate::number::CellFault;

/// A recording that cannot be opened, read or written; [`ReplayError::hint`] says what to do.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The file is missing or may not be read.
    #[error("\"{}\" cannot be opened", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Reading stopped at an error of the system.
    #[error("\"{}\" cannot be read further", path.display())]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file could not be written.
    #[error("\"{}\" cannot be written", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system or the MCAP writer said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A recording without files.
    #[error("recording \"{recording}\" names no file")]
    NoFiles {
        /// Name of the recording.
        recording: String,
    },
    /// A file of no bytes.
    #[error("\"{}\" is empty (0 bytes)", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A table in UTF-16.
    #[error("\"{}\" is text in UTF-16, read are UTF-8 and Latin-1", path.display())]
    Utf16 {
        /// The file.
        path: PathBuf,
    },
    /// A table whose header is followed by no row of numbers.
    #[error("\"{}\" has a header but no row of numbers", path.display())]
    HeaderOnly {
        /// The file.
        path: PathBuf,
    },
    /// A recording whose channels hold no sample.
    #[error("recording \"{recording}\" holds no sample of any of its channels")]
    NoSamples {
        /// Name of the recording.
        recording: String,
    },
    /// A file was given for a channel that the campaign's columns do not name.
    #[error("\"{}\" is to hold {}, but no column is given for {}",
        path.display(), quantity.name(), quantity.name())]
    MissingChannel {
        /// The file.
        path: PathBuf,
        /// The channel.
        quantity: Quantity,
    },
    /// No channel at all is mapped.
    #[error("no column is given for any channel of \"{}\"", path.display())]
    NoChannels {
        /// The file.
        path: PathBuf,
    },
    /// A channel was given twice.
    #[error("recording \"{recording}\" holds {} twice", quantity.name())]
    ChannelTwice {
        /// Name of the recording.
        recording: String,
        /// The channel.
        quantity: Quantity,
    },
    /// A column that the header does not name.
    #[error("\"{}\" has no column \"{column}\" for {channel}; its columns are {}",
        path.display(), listed(present))]
    MissingColumn {
        /// The file.
        path: PathBuf,
        /// What the column was to carry.
        channel: &'static str,
        /// The column looked for.
        column: String,
        /// The columns in the header.
        present: Vec<String>,
    },
    /// A column that the header names more than once.
    #[error("\"{}\" has {count} columns named \"{column}\"", path.display())]
    RepeatedColumn {
        /// The file.
        path: PathBuf,
        /// The name.
        column: String,
        /// How often it stands in the header.
        count: usize,
    },
    /// Neither time column nor sample rate.
    #[error("\"{}\" has no time: neither a time column nor a sample rate is given", path.display())]
    NoTimeBase {
        /// The file.
        path: PathBuf,
    },
    /// A sample rate that is no rate.
    #[error("sample rate {rate_hz} Hz, expected a positive number")]
    SampleRate {
        /// The rate [Hz].
        rate_hz: f64,
    },
    /// A cell that is not a finite number.
    #[error("\"{}\" line {line}, column \"{column}\": \"{text}\" is {fault}", path.display())]
    Cell {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// Header of the column.
        column: String,
        /// The cell as it stands in the file.
        text: String,
        /// What is wrong with it.
        fault: CellFault,
    },
    /// A row in the middle of the file that stops before a needed column.
    #[error("\"{}\" line {line} has {found} cells, expected {expected}", path.display())]
    RowLength {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// Cells in the row.
        found: usize,
        /// Cells in the header.
        expected: usize,
    },
    /// A line without end.
    #[error("\"{}\" line {line} is longer than {limit_bytes} bytes", path.display())]
    LineTooLong {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// The limit [bytes].
        limit_bytes: u64,
    },
    /// Time that runs backwards within one channel.
    #[error("\"{}\" {place}: time runs backwards, {time_s} s after {previous_s} s", path.display())]
    TimeBackwards {
        /// The file.
        path: PathBuf,
        /// Line of a table, message of a topic.
        place: String,
        /// The time [s].
        time_s: f64,
        /// The time before it [s].
        previous_s: f64,
    },
    /// A stretch without time stamps that is too long to interpolate over.
    #[error("\"{}\" {place}: {limit} rows in a row without a time stamp of their own",
        path.display())]
    Unstamped {
        /// The file.
        path: PathBuf,
        /// Line of a table, message of a topic.
        place: String,
        /// The limit.
        limit: usize,
    },
    /// A time column without a single stamp.
    #[error("\"{}\" has no time stamp in any of its {rows} rows", path.display())]
    NoStamps {
        /// The file.
        path: PathBuf,
        /// Rows read.
        rows: u64,
    },
    /// A file named `.mcap` that is none.
    #[error("\"{}\" is not an MCAP file: it does not begin with the MCAP magic bytes",
        path.display())]
    NotMcap {
        /// The file.
        path: PathBuf,
    },
    /// An MCAP file with broken contents.
    #[error("\"{}\" is damaged in the record at byte {offset}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Byte at which the broken record begins.
        offset: u64,
        /// What the MCAP reader saw.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// An MCAP file without a single message.
    #[error("\"{}\" holds no message", path.display())]
    NoMessages {
        /// The file.
        path: PathBuf,
    },
    /// A channel without topic in a foreign MCAP file.
    #[error("no topic is given for {} in \"{}\"; its topics are {}",
        quantity.name(), path.display(), listed(present))]
    NoTopic {
        /// The file.
        path: PathBuf,
        /// The channel.
        quantity: Quantity,
        /// The topics in the file.
        present: Vec<String>,
    },
    /// A topic that the MCAP file does not hold.
    #[error("\"{}\" has no topic \"{topic}\" for {}; its topics are {}",
        path.display(), quantity.name(), listed(present))]
    MissingTopic {
        /// The file.
        path: PathBuf,
        /// The channel.
        quantity: Quantity,
        /// The topic looked for.
        topic: String,
        /// The topics in the file.
        present: Vec<String>,
    },
    /// A topic whose messages are in an encoding that is not read.
    #[error("\"{}\" topic \"{topic}\" is encoded in \"{encoding}\", read are \"json\" and \
        \"protobuf\"", path.display())]
    Encoding {
        /// The file.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Its message encoding.
        encoding: String,
    },
    /// A topic whose schema does not describe its messages.
    #[error("\"{}\" topic \"{topic}\" has no usable schema: {fault}", path.display())]
    Schema {
        /// The file.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// What is wrong with the schema.
        fault: String,
    },
    /// A message whose field is not a number.
    #[error("\"{}\" topic \"{topic}\", message {message}: field \"{field}\" is {found}",
        path.display())]
    Field {
        /// The file.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Message of the topic, counted from 1.
        message: u64,
        /// Path of the field.
        field: String,
        /// What stands there.
        found: String,
    },
    /// A value that cannot be recorded.
    #[error("{} {value} at {time_s} s cannot be recorded: {limit}", quantity.name())]
    Unrecordable {
        /// The channel.
        quantity: Quantity,
        /// Value in the channel's SI unit.
        value: f64,
        /// Time [s].
        time_s: f64,
        /// What is asked of it.
        limit: &'static str,
    },
    /// A record that cannot be recorded.
    #[error("{record} cannot be recorded: {limit}")]
    UnrecordableDocument {
        /// The record as the program holds it.
        record: String,
        /// What is asked of it.
        limit: &'static str,
    },
    /// No room was left in the middle of a recording.
    #[error("\"{}\" cannot grow beyond {written_bytes} bytes: the disk is full", path.display())]
    DiskFull {
        /// The part file, or what it was being turned into.
        path: PathBuf,
        /// Bytes of it that are whole and stay.
        written_bytes: u64,
        /// What the system said.
        source: io::Error,
    },
    /// Little room was left, and recording stopped while it could still be finished.
    #[error("\"{}\" stopped at {part_bytes} bytes: {free_bytes} bytes are free, to finish it and \
        to leave {reserve_bytes} bytes to others takes {}", path.display(),
        reserve_bytes + part_bytes)]
    NearlyFull {
        /// The recording.
        path: PathBuf,
        /// What is free [bytes].
        free_bytes: u64,
        /// What is left to others [bytes].
        reserve_bytes: u64,
        /// Bytes recorded so far, which stay.
        part_bytes: u64,
    },
    /// A part file that some recorder still writes to.
    #[error("\"{}\" is still being recorded", path.display())]
    InUse {
        /// The part file.
        path: PathBuf,
    },
    /// A part file that no recorder of ours wrote.
    #[error("\"{}\" is no part of a recording of ours", path.display())]
    NotPart {
        /// The file.
        path: PathBuf,
    },
    /// A finished file that does not read as it was written.
    #[error("\"{}\" was written but does not read back: {fault}", path.display())]
    NotKept {
        /// The file.
        path: PathBuf,
        /// What differs.
        fault: String,
    },
    /// A file that is there already.
    #[error("\"{}\" exists already, recordings are never overwritten", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
}

impl ReplayError {
    /// Whether it says that the disk has no room.
    pub fn is_for_want_of_room(&self) -> bool {
        matches!(self, Self::DiskFull { .. } | Self::NearlyFull { .. })
    }

    pub(crate) fn write(path: &Path, source: io::Error) -> Self {
        Self::Write { path: path.to_owned(), source: source.into() }
    }

    /// The error of a file that grew to a length.
    pub(crate) fn written(path: &Path, written_bytes: u64, source: io::Error) -> Self {
        if is_full(&source) {
            return Self::DiskFull { path: path.to_owned(), written_bytes, source };
        }
        Self::write(path, source)
    }
}

/// Whether an error says that there is no room, for whatever reason.
pub(crate) fn is_full(error: &io::Error) -> bool {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge)
}

/// Names in quotes, the first of them when there are many.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 40;
    const LETTERS: usize = 60;
    let quoted = names.iter().take(SHOWN).map(|name| {
        let short: String = name.chars().take(LETTERS).collect();
        format!("\"{}\"", short.escape_debug())
    });
    let shown = quoted.collect::<Vec<_>>().join(", ");
    match names.len() {
        0 => "none".to_owned(),
        count if count > SHOWN => format!("{shown} and {} more", count - SHOWN),
        _ => shown,
    }
}
