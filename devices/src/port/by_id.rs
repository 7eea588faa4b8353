//! Ports by a name that outlives replugging, and how long an adapter may hold bytes back.

use std::fs;
use std::path::{Path, PathBuf};

const BY_ID: &str = "/dev/serial/by-id";

/// A port of this machine.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FoundPort {
    /// The stable name, or the kernel's where it has no other.
    pub path: PathBuf,
    /// What it points to.
    pub device: PathBuf,
}

/// The serial ports of this machine, stable names first.
pub fn found_ports() -> Vec<FoundPort> {
    let mut ports: Vec<FoundPort> = entries(Path::new(BY_ID))
        .filter_map(|path| Some(FoundPort { device: fs::canonicalize(&path).ok()?, path }))
        .collect();
    ports.sort();
    let mut unnamed: Vec<FoundPort> = entries(Path::new("/dev"))
        .filter(|path| is_serial(path) && !ports.iter().any(|port| port.device == *path))
        .map(|path| FoundPort { device: path.clone(), path })
        .collect();
    unnamed.sort();
    ports.extend(unnamed);
    ports
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
}

/// USB adapters, USB modems and on-chip ports; `/dev/ttyS*` only where hardware answers.
fn is_serial(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let on_board = name.starts_with("ttyS") && {
        let kind = fs::read_to_string(format!("/sys/class/tty/{name}/type"));
        kind.is_ok_and(|kind| kind.trim() != "0")
    };
    let known = ["ttyUSB", "ttyACM", "ttyAMA"].iter().any(|kind| name.starts_with(kind));
    known || on_board
}

/// How long the adapter behind a port may hold bytes back [s]; an FTDI is set to 1 ms when allowed.
pub fn adapter_latency_s(path: &Path) -> Option<f64> {
    let device = fs::canonicalize(path).ok()?;
    let name = device.file_name()?.to_string_lossy();
    let timer = PathBuf::from(format!("/sys/bus/usb-serial/devices/{name}/latency_timer"));
    let read = || fs::read_to_string(&timer).ok()?.trim().parse::<f64>().ok();
    let before_ms = read()?;
    // The factory's 16 ms would cost a sixtieth of a second of knowledge about every sample.
    let wrote = before_ms > 1.0 && fs::write(&timer, "1").is_ok();
    let now_ms = if wrote { read()? } else { before_ms };
    Some(now_ms * 1e-3)
}
