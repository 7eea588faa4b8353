//! Serial ports: the only place that names `serialport`.

mod by_id;
mod link;
mod reader;

use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};

pub use by_id::{
    BY_ID_FOLDER, FoundPort, USB_SERIAL_FOLDER, adapter_latency_s, found_ports, stable_name,
};
pub use link::{LinkEvent, LinkOptions};
pub use reader::{LinkReader, LinkThread, Outlet};

/// Longest wait for room to write [ms].
const WRITE_TIMEOUT_MS: u64 = 200;

/// How a line is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Bits per second.
    pub baud: u32,
    /// 7 or 8.
    #[serde(default = "eight")]
    pub data_bits: u8,
    /// Parity bit.
    #[serde(default)]
    pub parity: Parity,
    /// 1 or 2.
    #[serde(default = "one")]
    pub stop_bits: u8,
}

fn eight() -> u8 {
    8
}

fn one() -> u8 {
    1
}

/// The parity bit of a line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Parity {
    /// No parity bit.
    #[default]
    None,
    /// Even parity.
    Even,
    /// Odd parity.
    Odd,
}

impl Line {
    /// One byte on the wire [ns].
    pub fn byte_ns(&self) -> u64 {
        let parity = u64::from(self.parity != Parity::None);
        let bits = 1 + u64::from(self.data_bits) + parity + u64::from(self.stop_bits);
        bits * 1_000_000_000 / u64::from(self.baud.max(1))
    }

    /// As instrument makers write it: `9600 8E1`.
    pub fn name(&self) -> String {
        let parity = match self.parity {
            Parity::None => 'N',
            Parity::Even => 'E',
            Parity::Odd => 'O',
        };
        format!("{} {}{parity}{}", self.baud, self.data_bits, self.stop_bits)
    }
}

/// Why a port could not be opened, or was lost.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PortFault {
    /// No such file.
    Missing,
    /// Another program has it.
    Busy,
    /// This user may not open it.
    Forbidden,
    /// It is no serial port.
    NotSerial,
    /// It does not take a setting: which, and what it has instead.
    Refused(String),
    /// Anything else, in the system's words.
    Other(String),
}

/// An open port.
pub(crate) struct Port {
    inner: serialport::TTYPort,
}

/// What a read brought.
pub(crate) enum Arrival {
    Bytes(usize),
    Idle,
    Lost(String),
}

impl Port {
    pub(crate) fn open(path: &Path, line: Line) -> Result<Self, PortFault> {
        if !path.exists() {
            return Err(PortFault::Missing);
        }
        let parity = match line.parity {
            Parity::None => serialport::Parity::None,
            Parity::Even => serialport::Parity::Even,
            Parity::Odd => serialport::Parity::Odd,
        };
        let data_bits = match line.data_bits {
            7 => serialport::DataBits::Seven,
            _ => serialport::DataBits::Eight,
        };
        let stop_bits = match line.stop_bits {
            2 => serialport::StopBits::Two,
            _ => serialport::StopBits::One,
        };
        let builder = serialport::new(path.to_string_lossy(), line.baud)
            .data_bits(data_bits)
            .parity(parity)
            .stop_bits(stop_bits)
            .flow_control(serialport::FlowControl::None)
            .timeout(Duration::from_millis(WRITE_TIMEOUT_MS));
        let inner = builder.open_native().map_err(|error| fault(&error))?;
        let port = Self { inner };
        // The driver below may drop a setting in silence; a pseudo-terminal has no parity bit.
        port.check("parity", &parity, serialport::SerialPort::parity)?;
        port.check("data bits", &data_bits, serialport::SerialPort::data_bits)?;
        port.check("stop bits", &stop_bits, serialport::SerialPort::stop_bits)?;
        Ok(port)
    }

    fn check<T: PartialEq + std::fmt::Display>(
        &self,
        what: &'static str,
        wanted: &T,
        read: impl Fn(&serialport::TTYPort) -> serialport::Result<T>,
    ) -> Result<(), PortFault> {
        match read(&self.inner) {
            Ok(got) if got == *wanted => Ok(()),
            Ok(got) => {
                Err(PortFault::Refused(format!("{what} \"{wanted}\" and stays at \"{got}\"")))
            }
            Err(error) => Err(PortFault::Other(error.to_string())),
        }
    }

    /// Waits for bytes at most so long.
    pub(crate) fn read(&mut self, bytes: &mut [u8], wait: Duration) -> Arrival {
        // Setting a timeout is a plain assignment in this crate, not a system call.
        if let Err(error) = serialport::SerialPort::set_timeout(&mut self.inner, wait) {
            return Arrival::Lost(error.to_string());
        }
        match self.inner.read(bytes) {
            // A hang-up on some drivers; taken for "no data yet" it would spin for ever.
            Ok(0) => Arrival::Lost("end of file".to_owned()),
            Ok(n_bytes) => Arrival::Bytes(n_bytes),
            Err(error) => match error.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => {
                    Arrival::Idle
                }
                _ => Arrival::Lost(error.to_string()),
            },
        }
    }

    pub(crate) fn write(&mut self, bytes: &[u8]) -> Result<(), String> {
        let wait = Duration::from_millis(WRITE_TIMEOUT_MS);
        serialport::SerialPort::set_timeout(&mut self.inner, wait)
            .map_err(|error| error.to_string())?;
        self.inner.write_all(bytes).map_err(|error| error.to_string())
    }
}

fn fault(error: &serialport::Error) -> PortFault {
    use serialport::ErrorKind as Kind;
    match error.kind() {
        Kind::NoDevice => PortFault::Busy,
        Kind::Io(ErrorKind::NotFound) => PortFault::Missing,
        Kind::Io(ErrorKind::PermissionDenied) => PortFault::Forbidden,
        _ if error.description.contains("Not a typewriter")
            || error.description.contains("Inappropriate ioctl") =>
        {
            PortFault::NotSerial
        }
        _ => PortFault::Other(error.description.clone()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_takes_its_bits_on_the_wire() {
        let even = Line { baud: 9600, data_bits: 8, parity: Parity::Even, stop_bits: 1 };
        assert_eq!((even.name().as_str(), even.byte_ns()), ("9600 8E1", 1_145_833));
    }

    #[test]
    fn the_systems_words_become_faults() {
        use serialport::ErrorKind as Kind;
        let of = |kind, text: &str| fault(&serialport::Error::new(kind, text));
        assert_eq!(of(Kind::NoDevice, "Unable to acquire exclusive lock"), PortFault::Busy);
        let forbidden = of(Kind::Io(ErrorKind::PermissionDenied), "Permission denied");
        assert_eq!(forbidden, PortFault::Forbidden);
        assert_eq!(of(Kind::Unknown, "Not a typewriter"), PortFault::NotSerial);
    }
}
