//! The browser that stories look through, installed when it is missing.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::debian;

/// Names under which Chromium and Chrome are installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// The program; `apt-get` installs it first where it is missing and we may.
///
/// # Panics
/// Where there is no browser and none can be installed: these stories are never skipped.
pub(crate) fn program() -> &'static Path {
    static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
        installed().unwrap_or_else(|| {
            debian::install("chromium");
            installed().expect("apt-get has installed chromium")
        })
    });
    &PROGRAM
}

fn installed() -> Option<PathBuf> {
    let named = std::env::var_os("ROLLTANK_CHROMIUM").map(PathBuf::from);
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let below = |folder: PathBuf| NAMES.map(|name| folder.join(name));
    named.into_iter().chain(std::env::split_paths(&folders).flat_map(below)).find(|p| p.is_file())
}
