//! A delimited text file as rows of cells: delimiter found, header read, lines bounded.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use csv::{ByteRecord, Reader, ReaderBuilder};

use crate::error::ReplayError;
use crate::number::{CellFault, Numbers};

/// Longest line read [bytes].
pub(crate) const LINE_BYTES_MAX: u64 = 1 << 20;
/// Bytes looked at to find the delimiter.
const SNIFFED_BYTES: u64 = 1 << 16;
/// Bytes asked of the system at once.
const BUFFER_BYTES: usize = 1 << 16;
/// Delimiters tried, the most common first.
const DELIMITERS: [u8; 3] = [b',', b';', b'\t'];

/// Rows of a delimited text file.
pub(crate) struct CsvFile {
    path: PathBuf,
    reader: Reader<Bounded>,
    record: ByteRecord,
    /// The first row was read when the file was opened, to see whether it holds units.
    held: bool,
    header: Vec<String>,
    delimiter: u8,
    bytes_total: u64,
}

impl CsvFile {
    /// Opens the file and reads its header; `wanted` are the columns that tell the delimiter.
    pub(crate) fn open(path: &Path, wanted: &[&str]) -> Result<Self, ReplayError> {
        let mut file = open(path)?;
        let read_error = |source| ReplayError::Read { path: path.to_owned(), source };
        let bytes_total = file.metadata().map_err(read_error)?.len();
        let mut start = Vec::new();
        (&mut file).take(SNIFFED_BYTES).read_to_end(&mut start).map_err(read_error)?;
        file.rewind().map_err(read_error)?;
        if start.is_empty() {
            return Err(ReplayError::Empty { path: path.to_owned() });
        }
        if start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]) {
            return Err(ReplayError::Utf16 { path: path.to_owned() });
        }
        let (delimiter, header) = sniff(&start, wanted);
        let bounded = Bounded { file, since_record: 0 };
        let mut csv = Self {
            path: path.to_owned(),
            reader: builder(delimiter).from_reader(bounded),
            record: ByteRecord::new(),
            held: false,
            header,
            delimiter,
            bytes_total,
        };
        csv.read_record()?;
        csv.held = csv.read_record()? && (!csv.is_text_only() || csv.read_record()?);
        if csv.held { Ok(csv) } else { Err(ReplayError::HeaderOnly { path: path.to_owned() }) }
    }

    /// The header's columns as spelled in the file.
    pub(crate) fn header(&self) -> &[String] {
        &self.header
    }

    /// The byte between cells.
    pub(crate) fn delimiter(&self) -> u8 {
        self.delimiter
    }

    /// Index of a column by its header, blanks around it apart.
    pub(crate) fn column(&self, name: &str, channel: &'static str) -> Result<usize, ReplayError> {
        let matches = |same: &dyn Fn(&str) -> bool| -> Vec<usize> {
            (0..self.header.len()).filter(|&index| same(&self.header[index])).collect()
        };
        let mut found = matches(&|header| header == name);
        if found.is_empty() {
            found = matches(&|header| header.trim() == name.trim());
        }
        match found[..] {
            [index] => Ok(index),
            [] => Err(ReplayError::MissingColumn {
                path: self.path.clone(),
                channel,
                column: name.to_owned(),
                present: self.header.clone(),
            }),
            _ => Err(ReplayError::RepeatedColumn {
                path: self.path.clone(),
                column: name.to_owned(),
                count: found.len(),
            }),
        }
    }

    /// Moves to the next row and says whether there is one.
    pub(crate) fn next_row(&mut self) -> Result<bool, ReplayError> {
        if std::mem::take(&mut self.held) {
            return Ok(true);
        }
        self.read_record()
    }

    /// Cells of the current row.
    pub(crate) fn row(&self) -> &ByteRecord {
        &self.record
    }

    /// Byte at which the current row begins, line ends before it included.
    pub(crate) fn row_byte(&self) -> u64 {
        self.record.position().map_or(0, csv::Position::byte)
    }

    /// Bytes read so far.
    pub(crate) fn bytes_read(&self) -> u64 {
        self.reader.position().byte().min(self.bytes_total)
    }

    /// Bytes of the file.
    pub(crate) fn bytes_total(&self) -> u64 {
        self.bytes_total
    }

    fn read_record(&mut self) -> Result<bool, ReplayError> {
        self.reader.get_mut().since_record = 0;
        let byte = self.reader.position().byte();
        match self.reader.read_byte_record(&mut self.record) {
            Ok(more) => Ok(more),
            Err(_) if self.reader.get_ref().since_record >= LINE_BYTES_MAX => {
                Err(ReplayError::LineTooLong {
                    path: self.path.clone(),
                    line: line_at(&self.path, byte),
                    limit_bytes: LINE_BYTES_MAX,
                })
            }
            Err(error) => {
                Err(ReplayError::Read { path: self.path.clone(), source: io::Error::from(error) })
            }
        }
    }

    /// Whether the current row is a line of units or comments: no cell of it is a number.
    fn is_text_only(&self) -> bool {
        let text = |cell: &[u8]| {
            let read = Numbers::new(b';').read(cell);
            matches!(read, Ok(None) | Err(CellFault::NotNumber))
        };
        let blank = |cell: &[u8]| cell.trim_ascii().is_empty();
        self.record.iter().all(text) && !self.record.iter().all(blank)
    }
}

/// Opens a file for reading.
pub(crate) fn open(path: &Path) -> Result<File, ReplayError> {
    let opened = File::open(path);
    opened.map_err(|source| ReplayError::Open { path: path.to_owned(), source })
}

/// Line, counted from 1, of the row that begins at `byte`; reads the file up to there.
pub(crate) fn line_at(path: &Path, byte: u64) -> u64 {
    let Ok(file) = File::open(path) else { return 0 };
    let mut line = 1;
    let mut after_return = false;
    for (index, next) in (0_u64..).zip(BufReader::with_capacity(BUFFER_BYTES, file).bytes()) {
        let Ok(next) = next else { break };
        // The csv reader takes line ends before a row as part of it.
        if index >= byte && !matches!(next, b'\r' | b'\n') {
            break;
        }
        line += u64::from(next == b'\r' || (next == b'\n' && !after_return));
        after_return = next == b'\r';
    }
    line
}

/// The delimiter under which the first line has most of the wanted columns, then most columns.
fn sniff(start: &[u8], wanted: &[&str]) -> (u8, Vec<String>) {
    let mut best = (0, 0, DELIMITERS[0], Vec::new());
    for delimiter in DELIMITERS {
        let mut record = ByteRecord::new();
        // Reading from memory cannot fail, and a line without end gives what there is of it.
        let _more = builder(delimiter).from_reader(start).read_byte_record(&mut record);
        let header: Vec<String> = record.iter().map(text_of).collect();
        let found =
            wanted.iter().filter(|name| header.iter().any(|cell| cell.trim() == name.trim()));
        let found = found.count();
        if (found, header.len()) > (best.0, best.1) {
            best = (found, header.len(), delimiter, header);
        }
    }
    (best.2, best.3)
}

/// A cell as text: UTF-8, or else Latin-1, which every byte is.
pub(crate) fn text_of(cell: &[u8]) -> String {
    match std::str::from_utf8(cell) {
        Ok(text) => text.to_owned(),
        Err(_) => cell.iter().copied().map(char::from).collect(),
    }
}

fn builder(delimiter: u8) -> ReaderBuilder {
    let mut builder = ReaderBuilder::new();
    // Rows of other lengths are judged here, where the message can name the line.
    builder.has_headers(false).flexible(true).delimiter(delimiter).buffer_capacity(BUFFER_BYTES);
    builder
}

/// A file that refuses to go on when a row takes more than [`LINE_BYTES_MAX`].
struct Bounded {
    file: File,
    since_record: u64,
}

impl Read for Bounded {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.since_record >= LINE_BYTES_MAX {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "line without end"));
        }
        let read = self.file.read(buffer)?;
        self.since_record += read as u64;
        Ok(read)
    }
}
