//! The channels of one delimited text file that share one time base, as a stream of samples.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use devices::{Quantity, Sample};

use crate::columns::{ChannelColumn, TimeColumn};
use crate::csv_file::{CsvFile, line_at, text_of};
use crate::error::ReplayError;
use crate::note::{Note, Tally};
use crate::number::{CellFault, Numbers};
use crate::stamps::{StampFault, Stamped, Stamps, WAITING_MAX};
use crate::stream::Stream;

/// How the rows of a table get their times.
#[derive(Debug, Clone, Copy)]
pub(crate) enum TimeBase<'a> {
    /// From a column of time stamps.
    Column(&'a TimeColumn),
    /// From a sample rate [Hz]; the first row is at 0 s.
    Rate(f64),
}

/// Values of one row in the order of the stream's channels.
type Row = [Option<f64>; Quantity::ALL.len()];

/// Channels of one file on one time base.
pub(crate) struct CsvStream {
    path: PathBuf,
    file: CsvFile,
    numbers: Numbers,
    time: Time,
    channels: Vec<Channel>,
    stamps: Stamps<Row>,
    queue: VecDeque<Sample>,
    rows: u64,
    ended: bool,
    missing: Tally,
    repeated: Tally,
    /// Line of a last row that was cut short.
    cut_line: Option<u64>,
}

enum Time {
    Column { index: usize, seconds_per_unit: f64 },
    Rate(f64),
}

struct Channel {
    quantity: Quantity,
    index: usize,
    si_per_unit: f64,
    empty: Tally,
}

impl CsvStream {
    /// Opens the file for channels in the order of [`Quantity::ALL`].
    pub(crate) fn open(
        path: &Path,
        base: TimeBase<'_>,
        columns: &[&ChannelColumn],
    ) -> Result<Self, ReplayError> {
        let mut wanted: Vec<&str> = columns.iter().map(|column| column.column.as_str()).collect();
        if let TimeBase::Column(time) = base {
            wanted.push(&time.column);
        }
        let file = CsvFile::open(path, &wanted)?;
        let time = match base {
            TimeBase::Column(time) => Time::Column {
                index: file.column(&time.column, "time")?,
                seconds_per_unit: time.seconds_per_unit,
            },
            TimeBase::Rate(rate_hz) => Time::Rate(rate_hz),
        };
        let mut channels = Vec::new();
        for column in columns {
            channels.push(Channel {
                quantity: column.quantity,
                index: file.column(&column.column, column.quantity.name())?,
                si_per_unit: column.si_per_unit,
                empty: Tally::default(),
            });
        }
        Ok(Self {
            path: path.to_owned(),
            numbers: Numbers::new(file.delimiter()),
            file,
            time,
            channels,
            stamps: Stamps::new(),
            queue: VecDeque::new(),
            rows: 0,
            ended: false,
            missing: Tally::default(),
            repeated: Tally::default(),
            cut_line: None,
        })
    }

    /// Reads one row into the stamps, or finds the end of the file.
    fn read_row(&mut self) -> Result<(), ReplayError> {
        if !self.file.next_row()? {
            self.ended = true;
            self.stamps.finish();
            if self.rows > 0 && !self.stamps.any() {
                return Err(ReplayError::NoStamps { path: self.path.clone(), rows: self.rows });
            }
            return Ok(());
        }
        if self.is_passed_over()? {
            return self.read_row();
        }
        let time_s = match self.time {
            Time::Rate(rate_hz) => Some(self.rows as f64 / rate_hz),
            Time::Column { index, seconds_per_unit } => self.value(index, seconds_per_unit)?,
        };
        let mut row = Row::default();
        let byte = self.file.row_byte();
        for (slot, value) in row.iter_mut().enumerate().take(self.channels.len()) {
            let Channel { index, si_per_unit, .. } = self.channels[slot];
            *value = self.value(index, si_per_unit)?;
            if value.is_none() {
                self.channels[slot].empty.add(|| line_at(&self.path, byte));
            }
        }
        self.rows += 1;
        let stamped =
            self.stamps.push(time_s, row).map_err(|fault| self.misplaced(fault, time_s))?;
        match stamped {
            Stamped::Kept => {}
            Stamped::Missing => self.missing.add(|| line_at(&self.path, byte)),
            Stamped::Repeated => self.repeated.add(|| line_at(&self.path, byte)),
        }
        Ok(())
    }

    /// Whether to pass over the row: it is blank, or the file's last and cut short.
    fn is_passed_over(&mut self) -> Result<bool, ReplayError> {
        let expected = self.file.header().len();
        let row = self.file.row();
        let needed = self.channels.iter().map(|channel| channel.index).max().unwrap_or(0);
        let needed = match self.time {
            Time::Column { index, .. } => needed.max(index),
            Time::Rate(_) => needed,
        };
        let short = row.len() <= needed;
        let blank = |cell: &[u8]| cell.trim_ascii().is_empty();
        let long = row.len() > expected && !row.iter().skip(expected).all(blank);
        if !short && !long {
            return Ok(false);
        }
        if row.iter().all(blank) {
            return Ok(true);
        }
        let (found, byte) = (row.len(), self.file.row_byte());
        if short && !self.file.next_row()? {
            self.cut_line = Some(line_at(&self.path, byte));
            return Ok(true);
        }
        let line = line_at(&self.path, byte);
        Err(ReplayError::RowLength { path: self.path.clone(), line, found, expected })
    }

    /// The number in a cell of the current row, in SI units.
    fn value(&mut self, index: usize, si_per_unit: f64) -> Result<Option<f64>, ReplayError> {
        let cell = self.file.row().get(index).unwrap_or_default();
        let read = self.numbers.read(cell).and_then(|number| match number {
            Some(number) if !(number * si_per_unit).is_finite() => Err(CellFault::NotFinite),
            number => Ok(number.map(|number| number * si_per_unit)),
        });
        read.map_err(|fault| ReplayError::Cell {
            path: self.path.clone(),
            line: line_at(&self.path, self.file.row_byte()),
            column: self.file.header()[index].clone(),
            text: text_of(cell).chars().take(60).flat_map(char::escape_debug).collect(),
            fault,
        })
    }

    fn misplaced(&self, fault: StampFault, time_s: Option<f64>) -> ReplayError {
        let path = self.path.clone();
        let place = format!("line {}", line_at(&self.path, self.file.row_byte()));
        match fault {
            StampFault::Backwards { previous_s } => {
                let time_s = time_s.unwrap_or(previous_s);
                ReplayError::TimeBackwards { path, place, time_s, previous_s }
            }
            StampFault::TooManyWaiting => {
                ReplayError::Unstamped { path, place, limit: WAITING_MAX }
            }
        }
    }
}

impl Stream for CsvStream {
    fn next(&mut self) -> Result<Option<Sample>, ReplayError> {
        loop {
            if let Some(sample) = self.queue.pop_front() {
                return Ok(Some(sample));
            }
            if let Some((time_s, row)) = self.stamps.pop() {
                for (channel, value) in self.channels.iter().zip(row) {
                    let quantity = channel.quantity;
                    self.queue.extend(value.map(|value| Sample { quantity, time_s, value }));
                }
            } else if self.ended {
                return Ok(None);
            } else {
                self.read_row()?;
            }
        }
    }

    fn bytes_read(&self) -> u64 {
        self.file.bytes_read()
    }

    fn bytes_total(&self) -> u64 {
        self.file.bytes_total()
    }

    fn notes(&self, notes: &mut Vec<Note>) {
        let path = self.path.display();
        for (tally, what) in [(&self.missing, "without"), (&self.repeated, "repeating")] {
            if tally.count > 0 {
                let rows = tally.told("row", "line");
                notes.push(Note::mended(format!(
                    "\"{path}\": {rows}, {what} a time stamp, placed evenly between neighbours"
                )));
            }
        }
        if self.stamps.left_out > 0 {
            notes.push(Note::lost(format!(
                "\"{path}\": {} rows at the start or end left out, as no time stamp is on one side",
                self.stamps.left_out
            )));
        }
        for channel in self.channels.iter().filter(|channel| channel.empty.count > 0) {
            notes.push(Note::mended(format!(
                "\"{path}\" column \"{}\": {} of {} rows",
                self.file.header()[channel.index],
                channel.empty.told("empty cell", "line"),
                self.rows
            )));
        }
        if let Some(line) = self.cut_line {
            notes.push(Note::lost(format!("\"{path}\": the last line, {line}, is cut short")));
        }
    }
}
