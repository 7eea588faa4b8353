//! A tank for stories about the daemon: emulated instruments on real ports, and the program itself.

mod daemon;
mod signals;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, emulator};
use devices::setup::DeviceConfig;
use rolltank::campaign;

pub(crate) use daemon::Daemon;
pub(crate) use signals::{B1_PER_S, RELEASED_S};

use signals::{ROUND_S, raw_force, raw_roll, raw_speed};

/// The campaign file of the tank, its ports below the folder.
pub(crate) const CAMPAIGN: &str = r#"name = "emulated tank"
[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[tank]
carriage_max_speed_m_s = 2.0
[live]
condition = "bare hull"
[[device]]
name = "potentiometer"
profile = "cobs-board"
port = "PORTS/potentiometer"
settings = { fields = 1, identify = true }
[[device.channel]]
quantity = "roll"
field = 0
range = [-0.8, 0.8]
calibration = { curve = { gain = 1e-5 }, by = "A. Nilsson", at = "2026-11-26" }
[[device]]
name = "carriage"
profile = "arduino-text"
port = "PORTS/carriage"
settings = { pattern = "$RD,{sequence},{time_us},{0}*{xor}" }
[[device.channel]]
quantity = "speed"
field = 0
calibration = { curve = { gain = 1e-3 } }
"#;

/// The name of a device that samples at 2 kHz; every other does at 100 Hz.
pub(crate) const FAST: &str = "fast board";

/// A force cell that nobody has calibrated.
const CELL: &str = r#"[[device]]
name = "cell"
profile = "arduino-text"
port = "PORTS/cell"
settings = { pattern = "$RD,{sequence},{time_us},{0}*{xor}" }
[[device.channel]]
quantity = "force"
field = 0
"#;

/// The folder of a campaign whose instruments are emulated in this process.
pub(crate) struct LiveTank {
    folder: tempfile::TempDir,
    ports: Vec<EmulatedPort>,
    pub(crate) clock: Arc<WallClock>,
    pub(crate) speed: f64,
    /// Counts that a hand adds to what the force cell reads.
    pub(crate) load_counts: Arc<AtomicI64>,
    is_calm: bool,
}

impl LiveTank {
    /// Plugs every instrument of [`CAMPAIGN`] in, on a clock of that speed.
    pub(crate) fn at_speed(speed: f64) -> Self {
        Self::with(CAMPAIGN, speed, false)
    }

    /// The same with a model that nobody touches.
    pub(crate) fn calm_at_speed(speed: f64) -> Self {
        Self::with(CAMPAIGN, speed, true)
    }

    /// The instruments of these `[[device]]` tables, in real time.
    pub(crate) fn of_devices(devices: &str) -> Self {
        let rest = CAMPAIGN.split("[[device]]").next().unwrap_or_default();
        Self::with(&format!("{rest}{devices}"), 1.0, false)
    }

    /// The same with a model that nobody touches.
    pub(crate) fn calm_of_devices(devices: &str) -> Self {
        let rest = CAMPAIGN.split("[[device]]").next().unwrap_or_default();
        Self::with(&format!("{rest}{devices}"), 1.0, true)
    }

    /// A model that nobody touches, and a force cell to be loaded, on a clock of that speed.
    pub(crate) fn with_a_cell(speed: f64) -> Self {
        let head = CAMPAIGN.split("[[device]]").take(2).collect::<Vec<_>>().join("[[device]]");
        let head = head.replace("[live]", "[exciter]\nmoment_arm_m = 0.43\n[live]");
        Self::with(&format!("{head}{CELL}"), speed, true)
    }

    fn with(text: &str, speed: f64, is_calm: bool) -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let ports = folder.path().join("ports");
        fs::create_dir(&ports).expect("it is empty");
        let text = text.replace("PORTS", &ports.display().to_string());
        fs::write(folder.path().join("campaign.toml"), text).expect("the disk has room");
        let clock = Arc::new(WallClock::start_at_speed(speed));
        let load_counts = Arc::default();
        let mut tank = Self { folder, ports: Vec::new(), clock, speed, load_counts, is_calm };
        let campaign = campaign::read(tank.path()).unwrap_or_else(|error| panic!("{error:?}"));
        for device in &campaign.live.devices {
            let port = tank.plugged_in(device);
            tank.ports.push(port);
        }
        tank
    }

    fn plugged_in(&self, device: &DeviceConfig) -> EmulatedPort {
        let (quantity, is_calm) = (device.channels[0].quantity, self.is_calm);
        let load_counts = Arc::clone(&self.load_counts);
        let signal = move |field: usize, time_s: f64| match quantity {
            _ if field > 0 => raw_force(time_s),
            // The middle of the rest between two rounds.
            devices::Quantity::Roll if is_calm => raw_roll((time_s % 2.0) + 1.0),
            devices::Quantity::Roll => raw_roll(time_s),
            devices::Quantity::Speed => raw_speed(time_s),
            _ => raw_force(time_s) + load_counts.load(Ordering::Relaxed) as f64,
        };
        let settings = &device.settings;
        let rate_hz = if device.name == FAST { 2000.0 } else { 100.0 };
        let other_end = emulator(&device.driver, settings, rate_hz, Box::new(signal));
        let other_end = other_end.expect("the settings are good");
        let clock = Arc::clone(&self.clock) as Arc<dyn Clock>;
        EmulatedPort::plug_in(&device.port, other_end, device.line.byte_ns(), clock)
            .expect("a pseudo-terminal")
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// The port of the device at `index` of the campaign file.
    pub(crate) fn port(&self, index: usize) -> &EmulatedPort {
        &self.ports[index]
    }

    /// The tank's own time [s].
    pub(crate) fn now_s(&self) -> f64 {
        self.clock.now_ns() as f64 / 1e9
    }

    /// Sleeps until the tank's time is so long after the start of the round under way, or of the
    /// next.
    pub(crate) fn sleep_until_in_round(&self, at_s: f64) {
        let now_s = self.now_s();
        let mut until_s = (now_s / ROUND_S).floor() * ROUND_S + at_s;
        if until_s < now_s {
            until_s += ROUND_S;
        }
        std::thread::sleep(self.clock.real(((until_s - now_s) * 1e9) as u64));
    }

    /// Replaces a passage of the campaign file.
    pub(crate) fn edit(&self, from: &str, to: &str) {
        let path = self.path().join("campaign.toml");
        let text = fs::read_to_string(&path).expect("it is there");
        assert!(text.contains(from), "{from}");
        fs::write(path, text.replace(from, to)).expect("the disk has room");
    }

    /// Files below a folder of the campaign whose names end so, sorted.
    pub(crate) fn files(&self, below: &str, end: &str) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path().join(below)).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        files.retain(|path| path.to_string_lossy().ends_with(end));
        files.sort();
        files
    }

    /// The text of a file of the campaign; empty while it is not there.
    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap_or_default()
    }
}
