//! Ports by a name that outlives replugging, and how long an adapter may hold bytes back.

use std::fs;
use std::path::{Path, PathBuf};

/// Where the system keeps the stable names of serial ports.
pub const BY_ID_FOLDER: &str = "/dev/serial/by-id";

/// Where the system keeps the settings of USB adapters.
pub const USB_SERIAL_FOLDER: &str = "/sys/bus/usb-serial/devices";

/// A port of this machine.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FoundPort {
    /// The stable name, or the kernel's where it has no other.
    pub path: PathBuf,
    /// What it points to.
    pub device: PathBuf,
}

/// The serial ports of this machine, those with a stable name in `by_id_folder` first.
pub fn found_ports(by_id_folder: &Path) -> Vec<FoundPort> {
    let mut ports: Vec<FoundPort> = entries(by_id_folder)
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

/// The name in `by_id_folder` of a port that is called by another, which replugging may change.
pub fn stable_name(port: &Path, by_id_folder: &Path) -> Option<PathBuf> {
    let (is_stable, device) = (port.starts_with(by_id_folder), fs::canonicalize(port).ok()?);
    if is_stable {
        return None;
    }
    let mut names: Vec<PathBuf> = entries(by_id_folder)
        .filter(|name| fs::canonicalize(name).is_ok_and(|named| named == device))
        .collect();
    names.sort();
    names.into_iter().next()
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
pub fn adapter_latency_s(port: &Path, usb_serial_folder: &Path) -> Option<f64> {
    let device = fs::canonicalize(port).ok()?;
    let timer = usb_serial_folder.join(device.file_name()?).join("latency_timer");
    let read = || fs::read_to_string(&timer).ok()?.trim().parse::<f64>().ok();
    let before_ms = read()?;
    // The factory's 16 ms would cost a sixtieth of a second of knowledge about every sample.
    let wrote = before_ms > 1.0 && fs::write(&timer, "1").is_ok();
    let now_ms = if wrote { read()? } else { before_ms };
    Some(now_ms * 1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn a_port_by_the_kernels_name_has_its_stable_one_looked_up() {
        let folder = tempfile::tempdir().unwrap();
        let (ports, by_id) = (folder.path().join("dev"), folder.path().join("by-id"));
        for folder in [&ports, &by_id] {
            fs::create_dir(folder).unwrap();
        }
        let [first, second] = ["ttyUSB0", "ttyUSB1"].map(|name| ports.join(name));
        for port in [&first, &second] {
            fs::write(port, "").unwrap();
        }
        let name = by_id.join("usb-FTDI_A1-if00-port0");
        symlink("../dev/ttyUSB1", &name).unwrap();
        symlink("../dev/ttyUSB7", by_id.join("usb-gone")).unwrap();
        assert_eq!(stable_name(&second, &by_id), Some(name.clone()));
        assert_eq!(stable_name(&first, &by_id), None);
        assert_eq!(stable_name(&name, &by_id), None);
        assert_eq!(stable_name(&second, &folder.path().join("none")), None);
        let found = found_ports(&by_id);
        let device = fs::canonicalize(&second).unwrap();
        assert!(found.contains(&FoundPort { path: name, device }), "{found:?}");
    }

    #[test]
    fn the_timer_of_an_adapter_is_found_behind_the_ports_stable_name_and_set_to_a_millisecond() {
        let folder = tempfile::tempdir().unwrap();
        let (adapters, port) = (folder.path().join("devices"), folder.path().join("ttyUSB3"));
        let timer = adapters.join("ttyUSB3/latency_timer");
        fs::create_dir_all(timer.parent().unwrap()).unwrap();
        fs::write(&timer, "16\n").unwrap();
        fs::write(&port, "").unwrap();
        let name = folder.path().join("usb-FTDI_A1-if00-port0");
        symlink("ttyUSB3", &name).unwrap();
        assert_eq!(adapter_latency_s(&name, &adapters), Some(1e-3));
        assert_eq!(fs::read_to_string(&timer).unwrap(), "1");
        // Other adapters have no such timer.
        fs::remove_file(&timer).unwrap();
        assert_eq!(adapter_latency_s(&name, &adapters), None);
    }
}
