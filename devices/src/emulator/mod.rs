//! Instruments that are not there: each protocol's other end, on real pseudo-terminals.
//!
//! Written from the manuals' frames, with the same `[settings]` as the driver, one file each and
//! one line in [`EMULATORS`]. Faults come on command. The signals come from outside, so that a test
//! can send a number and a simulated tank a roll.

mod cable;
mod cobs_board;
mod dcon_module;
mod emulated_port;
mod faults;
mod hbm_digitiser;
mod heard;
mod line_pace;
mod mantrabus_cell;
mod mantracourt_cell;
mod misread;
mod modbus_transmitter;
mod openings;
mod text_board;

pub use emulated_port::{EmulatedPort, EmulatorError};
pub use faults::{Fault, Faults};

use serde::de::DeserializeOwned;

use line_pace::LinePace;

use crate::driver::{SettingsError, settings};

/// The raw value of a field [instrument's unit] at a time [s].
pub type Signal = Box<dyn Fn(usize, f64) -> f64 + Send>;

/// One line per emulator, named as the drivers are.
pub const EMULATORS: [EmulatorEntry; 8] = [
    EmulatorEntry { driver: "text-line", open: text_board::open },
    EmulatorEntry { driver: "mantracourt", open: mantracourt_cell::open },
    EmulatorEntry { driver: "mantrabus", open: mantrabus_cell::open },
    EmulatorEntry { driver: "dcon", open: dcon_module::open },
    EmulatorEntry { driver: "modbus-rtu", open: modbus_transmitter::open },
    EmulatorEntry { driver: "hbm-ascii", open: hbm_digitiser::open_ascii },
    EmulatorEntry { driver: "hbm-binary", open: hbm_digitiser::open_binary },
    EmulatorEntry { driver: "cobs", open: cobs_board::open },
];

/// What an emulator is made from.
pub struct Parts<'p> {
    settings: &'p toml::Table,
    rate_hz: f64,
    signal: Signal,
}

impl Parts<'_> {
    /// The settings of the driver that it answers, its own clock, its signals.
    fn read<S: DeserializeOwned>(self) -> Result<(S, LinePace, Signal), SettingsError> {
        Ok((settings(self.settings)?, LinePace::new(self.rate_hz), self.signal))
    }
}

/// How an emulator is made.
pub type Open = fn(Parts<'_>) -> Opened;

/// An emulator, or what is wrong with the settings.
pub type Opened = Result<Box<dyn Emulator>, SettingsError>;

/// An emulator's line in [`EMULATORS`].
pub struct EmulatorEntry {
    /// The driver that it answers.
    pub driver: &'static str,
    /// Makes it.
    pub open: Open,
}

/// The emulator that answers a driver.
///
/// # Errors
/// [`SettingsError`] for a driver without emulator, or for settings that it cannot work with.
pub fn emulator(driver: &str, settings: &toml::Table, rate_hz: f64, signal: Signal) -> Opened {
    let entry = EMULATORS.iter().find(|entry| entry.driver == driver);
    let entry = entry.ok_or_else(|| SettingsError(format!("nothing emulates \"{driver}\"")))?;
    (entry.open)(Parts { settings, rate_hz, signal })
}

/// An instrument without I/O: bytes and time in, bytes out.
pub trait Emulator: Send {
    /// Takes what the host sent, and appends the answers.
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>);

    /// Appends what it sends unasked by now.
    fn tick(&mut self, now_s: f64, faults: &mut Faults, out: &mut Vec<u8>);

    /// Power was switched off and on.
    fn restart(&mut self, now_s: f64);
}
