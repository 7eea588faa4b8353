//! The browser that stories look through, installed when it is missing.

use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{LazyLock, Mutex, PoisonError};

/// Names under which Chromium and Chrome are installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// The program; `apt-get` installs it first where it is missing and we may.
///
/// # Panics
/// Where there is no browser and none can be installed: these stories are never skipped.
pub(crate) fn program() -> &'static Path {
    static PROGRAM: LazyLock<PathBuf> = LazyLock::new(|| {
        installed().unwrap_or_else(|| {
            install("chromium");
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

/// A program of Debian, installed from its package where it is missing.
pub(crate) fn debian_program(name: &str, package: &str) -> PathBuf {
    let found = || {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|path| path.is_file())
    };
    found().unwrap_or_else(|| {
        install(package);
        found().expect("apt-get has installed it")
    })
}

fn install(package: &str) {
    // Two stories may miss two packages at once, and apt-get bears no other beside it.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    assert!(is_root(), "{package} is missing: install it with `apt-get install {package}`");
    for arguments in [&["update"][..], &["install", "-y", "--no-install-recommends", package]] {
        let status = Command::new("apt-get")
            .env("DEBIAN_FRONTEND", "noninteractive")
            .args(arguments)
            .status()
            .expect("apt-get runs");
        assert!(status.success(), "apt-get {arguments:?}: {status}");
    }
}

/// Whether this is root, for whom Chromium has no sandbox.
pub(crate) fn is_root() -> bool {
    std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
}
