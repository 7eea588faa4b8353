//! Programs of Debian that stories need, installed when they are missing.

use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

/// A program of Debian, installed from its package where it is missing.
pub(crate) fn program(name: &str, package: &str) -> PathBuf {
    let found = || {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|path| path.is_file())
    };
    found().unwrap_or_else(|| {
        install(package);
        found().expect("apt-get has installed it")
    })
}

/// Installs a package; another apt-get is waited for.
///
/// # Panics
/// Where it cannot be: a story is never skipped.
pub(crate) fn install(package: &str) {
    // Two stories may miss two packages at once, and apt-get bears no other beside it.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    assert!(is_root(), "{package} is missing: install it with `apt-get install {package}`");
    for arguments in [&["update"][..], &["install", "-y", "--no-install-recommends", package]] {
        let status = Command::new("apt-get")
            .env("DEBIAN_FRONTEND", "noninteractive")
            .args(["-o", "DPkg::Lock::Timeout=600"])
            .args(arguments)
            .status()
            .expect("apt-get runs");
        assert!(status.success(), "apt-get {arguments:?}: {status}");
    }
}

/// Whether this is root, who may install, and for whom Chromium has no sandbox.
pub(crate) fn is_root() -> bool {
    std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
}
