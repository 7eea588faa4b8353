//! A recording that has ended, from its part file to the finished one with its name.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use devices::Quantity;

use super::convert::convert;
use super::digest::Contents;
use super::disk::{Disk, keep_names, rename_onto_nothing};
use super::survey::Survey;
use super::with_suffix;
use crate::error::ReplayError;
use crate::record::ExitStatus;
use crate::topics::TOPICS;

/// Name of the metadata that ends a part file.
pub(crate) const STOP_METADATA: &str = "rolltank.stop";

/// How a recording ended and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exit {
    /// How.
    pub status: ExitStatus,
    /// Why.
    pub reason: String,
}

/// What a part file says about its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Stop {
    pub(crate) exit: Exit,
    /// Records that came after the disk was full.
    pub(crate) unrecorded: u64,
}

impl Exit {
    /// A recording that ended as it should.
    pub fn success(reason: &str) -> Self {
        Self { status: ExitStatus::Success, reason: reason.to_owned() }
    }

    /// As metadata.
    pub(crate) fn entries(&self, unrecorded: u64) -> BTreeMap<String, String> {
        let status = match self.status {
            ExitStatus::Success => "success",
            ExitStatus::Abort => "abort",
            ExitStatus::Fail => "fail",
            ExitStatus::Recovered => "recovered",
        };
        let texts = [
            ("exit_status", status.to_owned()),
            ("reason", self.reason.clone()),
            ("unrecorded", unrecorded.to_string()),
        ];
        texts.into_iter().map(|(key, text)| (key.to_owned(), text)).collect()
    }

    /// From metadata; none when it tells of no end.
    pub(crate) fn from_entries(entries: &BTreeMap<String, String>) -> Option<Stop> {
        let status = match entries.get("exit_status")?.as_str() {
            "success" => ExitStatus::Success,
            "abort" => ExitStatus::Abort,
            "fail" => ExitStatus::Fail,
            "recovered" => ExitStatus::Recovered,
            _ => return None,
        };
        let exit = Self { status, reason: entries.get("reason")?.clone() };
        Some(Stop { exit, unrecorded: entries.get("unrecorded")?.parse().ok()? })
    }
}

/// What a finished recording holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finished {
    /// The file.
    pub path: PathBuf,
    /// How the recording ended.
    pub exit: Exit,
    /// Samples of each channel, in the order of [`Quantity::ALL`].
    pub samples: Vec<(Quantity, u64)>,
    /// Messages of each topic.
    pub topics: BTreeMap<String, u64>,
    /// Runs that nobody had ended; their ends were added.
    pub runs_stopped: Vec<String>,
    /// Records that came after the disk was full, and are lost.
    pub unrecorded: u64,
    /// Bytes at the end of the part that were not wholly written, and are lost.
    pub torn_bytes: u64,
    /// Bytes before its end that the disk had spoilt, and are lost.
    pub spoilt_bytes: u64,
    /// Messages that such bytes made unreadable.
    pub unreadable: u64,
    /// Bytes of the part file.
    pub part_bytes: u64,
    /// Bytes of the finished file.
    pub file_bytes: u64,
}

/// A recording that is whole and kept as its part file, and still to be converted.
///
/// The conversion takes seconds for an hour of recording; it may run on another thread while the
/// next recording is under way.
pub struct ClosedRecording {
    pub(crate) target: PathBuf,
    pub(crate) part: PathBuf,
    /// Locked until the conversion is over.
    pub(crate) file: File,
    pub(crate) disk: Box<dyn Disk>,
    pub(crate) exit: Exit,
    pub(crate) unrecorded: u64,
}

impl ClosedRecording {
    /// Writes the indexed and compressed file, reads it back, and gives it its name.
    ///
    /// # Errors
    /// [`ReplayError::DiskFull`], [`ReplayError::Write`], [`ReplayError::NotKept`],
    /// [`ReplayError::Exists`] when the name was taken in the meantime. The part file stays as it
    /// is, for [`recover`](super::recover) to try again.
    pub fn convert(mut self) -> Result<Finished, ReplayError> {
        let survey = Survey::read(&self.part, &self.file)?;
        let stop = Stop { exit: self.exit, unrecorded: self.unrecorded };
        let disk = self.disk.as_mut();
        let written = Unnamed::write(&self.part, &self.file, &survey, &stop, disk)?;
        written.name(&self.target, &self.part)
    }
}

/// A finished file that was read back and has no name of its own yet; without one it is removed.
pub(crate) struct Unnamed {
    fresh: PathBuf,
    pub(crate) contents: Contents,
    finished: Finished,
    is_named: bool,
}

impl Unnamed {
    /// Converts a part file and compares what the new file holds with what was to be written.
    pub(crate) fn write(
        part: &Path,
        file: &File,
        survey: &Survey,
        stop: &Stop,
        disk: &mut dyn Disk,
    ) -> Result<Self, ReplayError> {
        let fresh = with_suffix(&part.with_extension(""), ".new");
        // The part is ours alone, so that this is what is left of an earlier conversion of it.
        if fresh.symlink_metadata().is_ok() {
            fs::remove_file(&fresh).map_err(|source| ReplayError::write(&fresh, source))?;
        }
        let length = |path: &Path| {
            let read = |source| ReplayError::Read { path: path.to_owned(), source };
            fs::metadata(path).map(|metadata| metadata.len()).map_err(read)
        };
        let mut unnamed = Self {
            finished: Finished {
                path: fresh.clone(),
                exit: stop.exit.clone(),
                samples: Vec::new(),
                topics: BTreeMap::new(),
                runs_stopped: survey.open_runs.iter().map(|open| open.run.clone()).collect(),
                unrecorded: stop.unrecorded,
                torn_bytes: survey.spoilt.torn_bytes,
                spoilt_bytes: survey.spoilt.stretch_bytes,
                unreadable: survey.unreadable,
                part_bytes: length(part)?,
                file_bytes: 0,
            },
            fresh,
            contents: Contents::default(),
            is_named: false,
        };
        let written = convert(part, file, survey, stop, disk, &unnamed.fresh)?;
        unnamed.contents = Contents::read(&unnamed.fresh)?;
        if unnamed.contents != written {
            let fault = format!("it reads as {:?}, written was {written:?}", unnamed.contents);
            return Err(ReplayError::NotKept { path: unnamed.fresh.clone(), fault });
        }
        unnamed.finished.file_bytes = length(&unnamed.fresh)?;
        let count = |topic: &str| written.topics.get(topic).copied();
        let samples = TOPICS.iter().filter_map(|topic| Some((topic.quantity, count(topic.name)?)));
        unnamed.finished.samples = samples.collect();
        unnamed.finished.topics = written.topics;
        Ok(unnamed)
    }

    /// Gives the file a name that is not taken, and removes the part that it was made from.
    pub(crate) fn name(mut self, target: &Path, part: &Path) -> Result<Finished, ReplayError> {
        rename_onto_nothing(&self.fresh, target).map_err(|source| match source.kind() {
            std::io::ErrorKind::AlreadyExists => ReplayError::Exists { path: target.to_owned() },
            _ => ReplayError::write(target, source),
        })?;
        self.is_named = true;
        let removed = fs::remove_file(part).and_then(|()| keep_names(part));
        removed.map_err(|source| ReplayError::write(part, source))?;
        let mut finished = self.finished.clone();
        target.clone_into(&mut finished.path);
        Ok(finished)
    }
}

impl Drop for Unnamed {
    fn drop(&mut self) {
        if !self.is_named {
            // It may not be there at all; the part it was made from is.
            drop(fs::remove_file(&self.fresh));
        }
    }
}
