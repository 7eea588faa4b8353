//! Folders for simulated campaigns: new or empty, so that nothing is ever overwritten.

use std::path::{Path, PathBuf};

use super::Failure;
use crate::tank;

/// Refuses a folder that holds something already.
pub(super) fn require_fresh(path: &Path) -> Result<(), Failure> {
    if is_fresh(path) { Ok(()) } else { Err(Failure::NotFresh { path: path.to_owned() }) }
}

/// The first of `name`, `name-2`, `name-3`, ... that is not there yet, nor its sealed truth.
pub(super) fn next_free(name: &str) -> PathBuf {
    let numbered = (2_u32..).map(|number| PathBuf::from(format!("{name}-{number}")));
    let mut names = std::iter::once(PathBuf::from(name)).chain(numbered);
    let taken =
        |path: &PathBuf| path.exists() || tank::truth_path(path).is_ok_and(|truth| truth.exists());
    names.find(|path| !taken(path)).expect("there are fewer folders than numbers")
}

fn is_fresh(path: &Path) -> bool {
    match path.read_dir() {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => !path.exists(),
    }
}
