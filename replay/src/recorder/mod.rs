//! Records a day in the tank so that a crash, a power cut or a full disk takes nothing recorded.
//!
//! A recording grows as `NAME.mcap.part`: groups of records, each handed to the system within
//! [`Settings::flush_s`] and kept by the disk within [`Settings::keep_s`]. [`Recorder::finish`]
//! turns it into the indexed, compressed, checked `NAME.mcap`, reads that back, and only then gives
//! it its name; [`recover`] does the same with the parts of a program that died. Nothing here reads
//! a clock: the writer's loop gives the time to [`Recorder::tick`].

mod closed;
mod convert;
mod digest;
mod disk;
mod journal;
mod layout;
mod open_run;
mod part_bytes;
mod part_reader;
mod pre_trigger;
mod recovery;
mod survey;
mod syncer;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::error::{ReplayError, is_full};
use crate::record::Record;

pub use closed::{ClosedRecording, Exit, Finished};
pub use disk::{Disk, LocalDisk};
pub use pre_trigger::PreTrigger;
pub use recovery::{Fate, Orphan, recover};

use closed::STOP_METADATA;
use disk::folder_of;
use journal::Journal;
use layout::{Backwards, Layout, declare};
use part_bytes::metadata;

/// Bytes of records after which a group is handed to the system, whatever its age.
const GROUP_BYTES: usize = 64 << 10;

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

/// How much a crash may take, and how much room is left to others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Age [s], on the records' own time and on the clock, at which records are handed to the
    /// system, where they outlive this program.
    pub flush_s: f64,
    /// Age [s] at which the disk is asked to keep them, so that they outlive a power cut.
    pub keep_s: f64,
    /// Free space [bytes], beyond what finishing may take, below which recording stops.
    pub reserve_bytes: u64,
}

impl Settings {
    /// For instruments: 50 ms at risk, so that a busy computer still keeps within 0.2 s.
    pub const LIVE: Self = Self { flush_s: 0.05, keep_s: 1.0, reserve_bytes: 64 << 20 };
    /// For what can be had again: handed over by size alone, kept when it is finished.
    pub const COPY: Self = Self { flush_s: f64::INFINITY, keep_s: f64::INFINITY, reserve_bytes: 0 };
}

/// What a recorder has done so far, for a page or a gauge.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Progress {
    /// Records taken.
    pub records: u64,
    /// Records that came after recording had stopped, and are lost.
    pub unrecorded: u64,
    /// Bytes of the part file.
    pub part_bytes: u64,
    /// Whether recording has stopped for want of room, or because the disk failed.
    pub stopped: bool,
}

/// Writes one recording: [`Recorder::push`] as records come, [`Recorder::tick`] as time passes,
/// then [`Recorder::finish`].
///
/// The samples of a channel come in time order. A recorder that is dropped unfinished leaves its
/// part behind, for [`recover`].
pub struct Recorder {
    target: PathBuf,
    journal: Journal,
    settings: Settings,
    zero_log_time_ns: u64,
    layout: Layout,
    waiting_records: u64,
    /// Time [s] of the first record that waits.
    waiting_since_s: Option<f64>,
    flushed: Duration,
    kept: Duration,
    progress: Progress,
}

impl Recorder {
    /// Starts to copy what can be had again, as a recording that will be `target`.
    ///
    /// # Errors
    /// As [`Recorder::start`].
    pub fn create(target: &Path, provenance: &Provenance) -> Result<Self, ReplayError> {
        Self::start(target, provenance, Settings::COPY, Box::new(LocalDisk))
    }

    /// Starts a recording that will be `target`.
    ///
    /// # Errors
    /// [`ReplayError::Exists`] when `target` or its part exists, [`ReplayError::NearlyFull`],
    /// [`ReplayError::Write`].
    pub fn start(
        target: &Path,
        provenance: &Provenance,
        settings: Settings,
        disk: Box<dyn Disk>,
    ) -> Result<Self, ReplayError> {
        refuse_existing(target)?;
        let mut journal = Journal::create(&part_of(target), disk)?;
        declare(journal.group(), provenance);
        let mut recorder = Self {
            target: target.to_owned(),
            journal,
            settings,
            zero_log_time_ns: provenance.zero_log_time_ns,
            layout: Layout::new(),
            waiting_records: 0,
            waiting_since_s: None,
            flushed: Duration::ZERO,
            kept: Duration::ZERO,
            progress: Progress::default(),
        };
        let started = recorder.check_room().and_then(|()| {
            let flushed = recorder.journal.flush().and_then(|()| recorder.journal.keep());
            flushed.map_err(|source| recorder.failed(source))
        });
        match started {
            Ok(()) => Ok(recorder),
            Err(error) => {
                recorder.abandon()?;
                Err(error)
            }
        }
    }

    /// Takes one record.
    ///
    /// A full or failing disk is told once, by the call that met it. Whatever was recorded before
    /// stays; from then on records are counted in [`Progress::unrecorded`] and let go, so that the
    /// caller goes on without a case of its own.
    ///
    /// # Errors
    /// [`ReplayError::Unrecordable`] and [`ReplayError::UnrecordableDocument`] when a number is not
    /// finite or the time has no log time, [`ReplayError::TimeBackwards`]: the record is not taken.
    /// [`ReplayError::DiskFull`] and [`ReplayError::Write`]: recording has stopped.
    pub fn push(&mut self, record: impl Into<Record>) -> Result<(), ReplayError> {
        let record = record.into();
        let log_time = self.log_time_ns(&record)?;
        if self.progress.stopped {
            self.progress.unrecorded += 1;
            return Ok(());
        }
        let time_s = record.time_s();
        let appended = self.layout.append(self.journal.group(), &record, log_time);
        if let Err(Backwards { previous_s }) = appended {
            let (path, place) = (self.target.clone(), channel_named(&record));
            return Err(ReplayError::TimeBackwards { path, place, time_s, previous_s });
        }
        self.progress.records += 1;
        self.waiting_records += 1;
        let waited_s = time_s - *self.waiting_since_s.get_or_insert(time_s);
        let is_stream = matches!(record, Record::Sample(_) | Record::Raw(_));
        let is_due = !is_stream || waited_s >= self.settings.flush_s;
        if is_due || self.journal.waiting_bytes() >= GROUP_BYTES {
            self.flush()?;
        }
        // A run's end and its result are worth a request of their own.
        if matches!(record, Record::RunStop(_) | Record::Result(_)) && self.keeps() {
            self.ask_to_keep()?;
        }
        Ok(())
    }

    /// Does what is due; `now` counts from any fixed instant and never goes back.
    ///
    /// # Errors
    /// [`ReplayError::NearlyFull`], [`ReplayError::DiskFull`], [`ReplayError::Write`]: recording
    /// has stopped, as [`Recorder::push`] tells.
    pub fn tick(&mut self, now: Duration) -> Result<(), ReplayError> {
        let due =
            |since: Duration, period_s: f64| now.saturating_sub(since).as_secs_f64() >= period_s;
        if !self.progress.stopped && due(self.flushed, self.settings.flush_s) {
            self.flushed = now;
            self.flush()?;
        }
        if !self.progress.stopped && due(self.kept, self.settings.keep_s) {
            self.kept = now;
            self.ask_to_keep()?;
            self.check_room()?;
        }
        Ok(())
    }

    /// What was done so far.
    pub fn progress(&self) -> Progress {
        Progress { part_bytes: self.journal.written_bytes(), ..self.progress }
    }

    /// Ends the recording and gives the file its name: [`Recorder::close`], then
    /// [`ClosedRecording::convert`].
    ///
    /// # Errors
    /// As [`ClosedRecording::convert`].
    pub fn finish(self, exit: Exit) -> Result<Finished, ReplayError> {
        self.close(exit)?.convert()
    }

    /// Ends the recording; what is left to do can be done on another thread.
    ///
    /// # Errors
    /// [`ReplayError::Write`] when the disk does not keep the part.
    pub fn close(mut self, exit: Exit) -> Result<ClosedRecording, ReplayError> {
        let mut unrecorded = self.progress.unrecorded;
        metadata(self.journal.group(), STOP_METADATA, &exit.entries(unrecorded));
        match self.journal.flush() {
            // The want of room was told when it stopped the recording; what is in the file stays.
            Err(error) if is_full(&error) && self.progress.stopped => {
                unrecorded += self.waiting_records;
            }
            Err(error) => return Err(self.failed(error)),
            Ok(()) => {}
        }
        self.journal.keep().map_err(|source| self.failed(source))?;
        let (part, file, disk) = self.journal.into_parts();
        Ok(ClosedRecording { target: self.target, part, file, disk, exit, unrecorded })
    }

    /// Gives the recording up and removes its part.
    ///
    /// # Errors
    /// [`ReplayError::Write`] when the part cannot be removed.
    pub fn abandon(self) -> Result<(), ReplayError> {
        let (part, file, _) = self.journal.into_parts();
        let removed = std::fs::remove_file(&part);
        drop(file);
        removed.map_err(|source| ReplayError::write(&part, source))
    }

    fn keeps(&self) -> bool {
        self.settings.keep_s.is_finite()
    }

    fn flush(&mut self) -> Result<(), ReplayError> {
        self.journal.flush().map_err(|source| self.stop(source))?;
        (self.waiting_since_s, self.waiting_records) = (None, 0);
        Ok(())
    }

    fn ask_to_keep(&mut self) -> Result<(), ReplayError> {
        self.journal.ask_to_keep().map_err(|source| self.stop(source))
    }

    /// Stops while there is still room to finish: the finished file is smaller than its part, and
    /// both are there for a moment.
    fn check_room(&mut self) -> Result<(), ReplayError> {
        let folder = folder_of(&self.target).to_owned();
        let free = self.journal.disk.free_bytes(&folder);
        let free_bytes = free.map_err(|source| ReplayError::Read { path: folder, source })?;
        let reserve_bytes = self.settings.reserve_bytes;
        if reserve_bytes > 0 && free_bytes < reserve_bytes + self.journal.written_bytes() {
            self.progress.stopped = true;
            let (path, part_bytes) = (self.target.clone(), self.journal.written_bytes());
            return Err(ReplayError::NearlyFull { path, free_bytes, reserve_bytes, part_bytes });
        }
        Ok(())
    }

    /// Stops recording because of an error of the system.
    fn stop(&mut self, source: std::io::Error) -> ReplayError {
        self.progress.stopped = true;
        self.failed(source)
    }

    fn failed(&self, source: std::io::Error) -> ReplayError {
        ReplayError::written(&self.journal.path, self.journal.written_bytes(), source)
    }

    fn log_time_ns(&self, record: &Record) -> Result<u64, ReplayError> {
        let refused = |limit| match record {
            Record::Sample(sample) => ReplayError::Unrecordable {
                quantity: sample.quantity,
                value: sample.value,
                time_s: sample.time_s,
                limit,
            },
            _ => ReplayError::UnrecordableDocument { record: format!("{record:?}"), limit },
        };
        if !record.is_finite() {
            return Err(refused("value and time must be finite"));
        }
        let log_time_ns =
            (record.time_s() * 1e9).round() as i128 + i128::from(self.zero_log_time_ns);
        u64::try_from(log_time_ns)
            .map_err(|_| refused("its log time must be 0 to 18.4e9 s, counted from time zero"))
    }
}

/// The name of a recording while it grows.
pub(crate) fn part_of(target: &Path) -> PathBuf {
    with_suffix(target, ".part")
}

pub(crate) fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(suffix);
    PathBuf::from(name)
}

/// A link that leads nowhere counts as a file that is there.
fn refuse_existing(path: &Path) -> Result<(), ReplayError> {
    match path.symlink_metadata() {
        Ok(_) => Err(ReplayError::Exists { path: path.to_owned() }),
        Err(_) => Ok(()),
    }
}

/// The channel of a sample, for a message.
fn channel_named(record: &Record) -> String {
    match record {
        Record::Sample(sample) => format!("channel {}", sample.quantity.name()),
        _ => "a document".to_owned(),
    }
}
