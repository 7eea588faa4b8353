//! Files that appear whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use super::ReportError;

/// Writes `name` in `dir`: first beside it, then renamed, so that no reader sees half a file.
pub fn write(dir: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let path = dir.join(name);
    let unfinished = dir.join(format!(".{name}.unfinished"));
    let attempt = fs::create_dir_all(dir)
        .and_then(|()| fs::write(&unfinished, bytes))
        .and_then(|()| fs::rename(&unfinished, &path));
    match attempt {
        Ok(()) => Ok(path),
        Err(source) => {
            // The leftover is hidden and is written over by the next attempt.
            fs::remove_file(&unfinished).ok();
            Err(ReportError::Write { path, source })
        }
    }
}
