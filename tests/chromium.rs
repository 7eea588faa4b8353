//! The browser that stories look through, installed when it is missing.

use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// Names under which Chromium and Chrome are installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// The program; `apt-get` installs it first where it is missing and we may.
///
/// # Panics
/// Where there is no browser and none can be installed: these stories are never skipped.
pub(crate) fn program() -> &'static Path {
    static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
        installed().unwrap_or_else(|| {
            install();
            installed().expect("apt-get has installed chromium")
        })
    });
    &PROGRAM
}

/// Arguments without which it does not start here: root has no sandbox.
pub(crate) fn arguments() -> &'static [&'static str] {
    if is_root() { &["--no-sandbox"] } else { &[] }
}

fn installed() -> Option<PathBuf> {
    let named = std::env::var_os("ROLLTANK_CHROMIUM").map(PathBuf::from);
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let below = |folder: PathBuf| NAMES.map(|name| folder.join(name));
    named.into_iter().chain(std::env::split_paths(&folders).flat_map(below)).find(|p| p.is_file())
}

fn install() {
    assert!(is_root(), "no Chromium is on PATH: install it with `apt-get install chromium`");
    for arguments in [&["update"][..], &["install", "-y", "--no-install-recommends", "chromium"]] {
        let status = Command::new("apt-get")
            .env("DEBIAN_FRONTEND", "noninteractive")
            .args(arguments)
            .status()
            .expect("apt-get runs");
        assert!(status.success(), "apt-get {arguments:?}: {status}");
    }
}

fn is_root() -> bool {
    std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
}
