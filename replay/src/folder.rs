//! The recordings in a campaign folder.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::ReplayError;

/// Every `*.csv` and `*.mcap` in the folder and its subfolders, sorted by path.
///
/// Folders named `results` are ours to write and not read; hidden files and folders are passed
/// over, and links to folders are not followed.
///
/// # Errors
/// [`ReplayError::Read`] when a folder cannot be read.
pub fn list_recordings(folder: &Path) -> Result<Vec<PathBuf>, ReplayError> {
    files_below(folder, &is_recording)
}

/// Every file wanted in the folder and its subfolders, by the rules of [`list_recordings`].
pub(crate) fn files_below(
    folder: &Path,
    is_wanted: &dyn Fn(&Path) -> bool,
) -> Result<Vec<PathBuf>, ReplayError> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let read_error = |source| ReplayError::Read { path: folder.clone(), source };
        for entry in fs::read_dir(&folder).map_err(read_error)? {
            let entry = entry.map_err(read_error)?;
            let name = entry.file_name();
            if name.as_encoded_bytes().starts_with(b".") {
                continue;
            }
            let kind = entry.file_type().map_err(read_error)?;
            if kind.is_dir() {
                if name != "results" {
                    folders.push(entry.path());
                }
            } else if is_wanted(&entry.path()) && entry.path().is_file() {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    Ok(files)
}

fn is_recording(path: &Path) -> bool {
    let is = |kind| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(kind));
    is("csv") || is("mcap")
}
