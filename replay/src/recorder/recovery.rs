//! Finishes the recordings of a program that died, at the start of the next.

use std::fs;
use std::path::{Path, PathBuf};

use super::closed::{Exit, Finished, Stop, Unnamed};
use super::digest::Contents;
use super::disk::{Disk, keep_names};
use super::journal::open_orphan;
use super::survey::Survey;
use crate::error::ReplayError;
use crate::folder::files_below;
use crate::record::ExitStatus;

/// Names tried for a recording whose own was taken.
const NAMES_MAX: u32 = 1000;

/// A part file that was found, and what became of it.
#[derive(Debug)]
pub struct Orphan {
    /// The part file.
    pub part: PathBuf,
    /// What became of it.
    pub fate: Fate,
}

/// What became of a part file.
#[derive(Debug)]
pub enum Fate {
    /// It is a recording now.
    Recovered(Finished),
    /// Its recording was finished already, equal to the last byte; the part was removed.
    AlreadyFinished {
        /// The recording.
        path: PathBuf,
    },
    /// Its recorder died before the first record; the part was removed.
    Empty,
    /// It was left as it is: somebody still records to it, the disk is full, it is none of ours.
    Left(ReplayError),
}

/// Finishes every part file in a folder and its subfolders, and tells of each.
///
/// A part that a recorder still writes to is locked, and left alone. Folders named `results` and
/// hidden ones are passed over.
///
/// # Errors
/// [`ReplayError::Read`] when a folder cannot be read. What is wrong with a part is told in its
/// [`Fate`].
pub fn recover(folder: &Path, disk: &mut dyn Disk) -> Result<Vec<Orphan>, ReplayError> {
    let parts =
        files_below(folder, &|path| path.as_os_str().as_encoded_bytes().ends_with(b".mcap.part"))?;
    let finish = |part: PathBuf| {
        let fate = finish_orphan(&part, disk).unwrap_or_else(Fate::Left);
        Orphan { part, fate }
    };
    Ok(parts.into_iter().map(finish).collect())
}

fn finish_orphan(part: &Path, disk: &mut dyn Disk) -> Result<Fate, ReplayError> {
    let file = open_orphan(part)?;
    let survey = Survey::read(part, &file)?;
    let target = part.with_extension("");
    if survey.is_empty() && survey.stop.is_none() {
        return remove(part).map(|()| Fate::Empty);
    }
    // Who came to close the recording but not to convert it has said how it ended.
    let stop = survey.stop.clone().unwrap_or_else(|| Stop {
        exit: Exit {
            status: ExitStatus::Recovered,
            reason: "the program that recorded it died".to_owned(),
        },
        unrecorded: 0,
    });
    let written = Unnamed::write(part, &file, &survey, &stop, disk)?;
    if target.symlink_metadata().is_err() {
        return written.name(&target, part).map(Fate::Recovered);
    }
    if Contents::read(&target).is_ok_and(|contents| contents == written.contents) {
        remove(part)?;
        return Ok(Fate::AlreadyFinished { path: target });
    }
    written.name(&free_name(&target)?, part).map(Fate::Recovered)
}

fn remove(part: &Path) -> Result<(), ReplayError> {
    let removed = fs::remove_file(part).and_then(|()| keep_names(part));
    removed.map_err(|source| ReplayError::write(part, source))
}

/// A name beside one that is taken: `pass-2.mcap` for `pass.mcap`.
fn free_name(target: &Path) -> Result<PathBuf, ReplayError> {
    let stem = target.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let named = |number| target.with_file_name(format!("{stem}-{number}.mcap"));
    let free = (2..NAMES_MAX).map(named).find(|path| path.symlink_metadata().is_err());
    free.ok_or_else(|| ReplayError::Exists { path: target.to_owned() })
}
