//! Instruments' languages: bytes in, readings out, and no port or clock anywhere.
//!
//! A driver is one file with pure encoding and decoding behind [`Protocol`], and one line in
//! [`DRIVERS`]. The [`Session`] around it is the same for all: it sends, waits, times out,
//! resynchronises and stamps. Both are functions of the bytes and times given, so a recording's raw
//! bytes go through the very driver that ran live.

mod cobs_stream;
mod dcon;
mod hbm_ascii;
mod hbm_binary;
mod hbm_line;
mod mantrabus;
mod mantracourt;
mod modbus;
mod modbus_opening;
mod pattern;
mod session;
mod text_line;

use serde::de::DeserializeOwned;

pub use session::{Decoded, Pace, Session, Taken};

pub(crate) use session::shown;

pub(crate) use cobs_stream::{Settings as CobsSettings, encode_frame, encode_identity, is_who};
pub(crate) use dcon::{Settings as DconSettings, checksum as dcon_checksum};
pub(crate) use hbm_ascii::Settings as HbmAsciiSettings;
pub(crate) use hbm_binary::Format as HbmFormat;
pub(crate) use hbm_binary::Settings as HbmBinarySettings;
pub(crate) use mantrabus::{Settings as MantrabusSettings, checksum, to_nibbles};
pub(crate) use mantracourt::Settings as MantracourtSettings;
pub(crate) use modbus::{NumberType, Settings as ModbusSettings, crc as modbus_crc};
pub(crate) use pattern::{Pattern, PatternValues};
pub(crate) use text_line::{IdentityLine, Settings as TextLineSettings};

use crate::Quality;

/// The longest frame of any protocol here [bytes]; nothing longer is ever waited for.
pub const FRAME_BYTES_MAX: usize = 512;

/// One line per driver.
pub const DRIVERS: [DriverEntry; 8] = [
    DriverEntry {
        name: "text-line",
        says: "lines of text by a pattern",
        asks: "give settings.identify, such as \"ID?\\r\\n\", and settings.identity_line, such as \
               \"ID {name}\"",
        open: text_line::open,
    },
    DriverEntry {
        name: "mantracourt",
        says: "Mantracourt ASCII",
        asks: ALWAYS,
        open: mantracourt::open,
    },
    DriverEntry {
        name: "mantrabus",
        says: "MANTRABUS-II binary",
        asks: "give settings.version_command, the number of VER in the manual's parameter table",
        open: mantrabus::open,
    },
    DriverEntry { name: "dcon", says: "DCON: ADAM-4000, I-7000", asks: ALWAYS, open: dcon::open },
    DriverEntry {
        name: "modbus-rtu",
        says: "Modbus RTU registers",
        asks: "give settings.identify: { function = 17 }, { function = 43 }, or the function, \
               address and number of registers that hold it",
        open: modbus::open,
    },
    DriverEntry {
        name: "hbm-ascii",
        says: "HBM/HBK AED, FIT in text",
        asks: ALWAYS,
        open: hbm_ascii::open,
    },
    DriverEntry {
        name: "hbm-binary",
        says: "HBM/HBK AED, FIT in binary",
        asks: ALWAYS,
        open: hbm_binary::open,
    },
    DriverEntry {
        name: "cobs",
        says: "COBS + CRC frames",
        asks: "give settings.identify = true",
        open: cobs_stream::open,
    },
];

/// Of a driver that asks whatever its settings are.
const ALWAYS: &str = "it asks by itself";

/// A driver's line in [`DRIVERS`].
pub struct DriverEntry {
    /// Name in profiles.
    pub name: &'static str,
    /// What it speaks, in a few words.
    pub says: &'static str,
    /// What makes it ask an instrument who it is.
    pub asks: &'static str,
    /// Makes the protocol from the `[settings]` of a profile.
    pub open: fn(&toml::Table) -> Result<Box<dyn Protocol>, SettingsError>,
}

/// The driver of that name.
pub fn driver(name: &str) -> Option<&'static DriverEntry> {
    DRIVERS.iter().find(|entry| entry.name == name)
}

/// Settings that a driver cannot work with.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct SettingsError(pub String);

/// Reads a driver's own settings.
pub(crate) fn settings<T: DeserializeOwned>(table: &toml::Table) -> Result<T, SettingsError> {
    table.clone().try_into().map_err(|error: toml::de::Error| {
        SettingsError(error.to_string().trim_end().replace('\n', " "))
    })
}

/// What is sent to an instrument.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// What for.
    pub purpose: Purpose,
    /// The protocol's own mark: which station, which field.
    pub tag: usize,
    /// Whether an answer comes.
    pub answered: bool,
}

/// What a request is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To learn which instrument answers.
    Identify,
    /// To set it up, or to stop it talking.
    Configure,
    /// To make every instrument on the bus measure at this instant.
    Hold,
    /// To learn the state that the next reading is delivered in.
    Status,
    /// To fetch readings.
    Read,
}

/// A protocol without I/O.
pub trait Protocol: Send {
    /// Names of the fields that it delivers, by field number; they stand in messages.
    fn fields(&self) -> Vec<String>;

    /// Addresses that it speaks to on the bus; empty when the line has one instrument.
    fn stations(&self) -> Vec<u16> {
        Vec::new()
    }

    /// Requests sent once when the link opens.
    fn opening(&self) -> Vec<Request>;

    /// Requests of one cycle; empty when the instrument talks unasked.
    fn cycle(&self) -> Vec<Request>;

    /// Fields that the answer to a request to read brings.
    fn fields_asked(&self, request: &Request) -> Vec<usize> {
        vec![request.tag]
    }

    /// The address that a request goes to, where the bus has such.
    fn station_asked(&self, request: &Request) -> Option<u16> {
        self.stations().get(request.tag).copied()
    }

    /// Whether it has a way to ask an instrument who it is.
    fn asks_who(&self) -> bool {
        self.opening().iter().any(|request| request.purpose == Purpose::Identify)
    }

    /// What stands at the start of `bytes`, which came after `asked`.
    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found;

    /// Widths of sequence number and device ticks, and ticks per second, where there are such.
    fn device_clock(&self) -> DeviceTicks {
        DeviceTicks::default()
    }
}

/// How an instrument counts its samples and its time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DeviceTicks {
    /// Width of the sequence number [bit].
    pub sequence_bits: Option<u32>,
    /// Width of the device time [bit].
    pub time_bits: Option<u32>,
    /// Ticks of the device time in a second.
    pub ticks_per_s: f64,
}

/// What [`Protocol::decode`] found at the start of the bytes.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Too little to tell; more bytes are needed.
    Part,
    /// Bytes without meaning and without harm: blank lines, a header.
    Skip {
        /// How many.
        n_bytes: usize,
    },
    /// A whole frame.
    Frame {
        /// Its length.
        n_bytes: usize,
        /// What it says.
        content: Content,
    },
    /// Bytes that are no frame.
    Noise {
        /// How many.
        n_bytes: usize,
        /// Why not.
        damage: Damage,
    },
}

/// What a frame says.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Readings taken at one instant.
    Values {
        /// One per field that the frame carries.
        values: Vec<FieldValue>,
        /// Sequence number, as wide as the protocol has it.
        sequence: Option<u64>,
        /// Device time, as wide as the protocol has it.
        ticks: Option<u64>,
    },
    /// Who the instrument is.
    Identity(String),
    /// A request was carried out.
    Accepted,
    /// A request was refused, with what the instrument said.
    Refused(String),
}

/// One reading in the instrument's own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldValue {
    /// Number in [`Protocol::fields`].
    pub field: usize,
    /// The value before calibration.
    pub raw: f64,
    /// What the instrument says of it.
    pub quality: Quality,
}

/// Why bytes are no frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Damage {
    /// They follow no form that this protocol has.
    Form,
    /// A check sum or check byte disagrees.
    Checksum,
    /// Longer than any frame.
    TooLong,
    /// An answer that was cut short.
    Cut,
    /// Another station answered than was asked.
    WrongStation,
}

impl Damage {
    /// The damage in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Form => "malformed",
            Self::Checksum => "check sum wrong",
            Self::TooLong => "too long",
            Self::Cut => "cut short",
            Self::WrongStation => "answer of another station",
        }
    }
}

/// One good reading.
pub(crate) fn value(field: usize, raw: f64, quality: Quality) -> FieldValue {
    FieldValue { field, raw, quality }
}

/// Readings without sequence number or device time.
pub(crate) fn plain(values: Vec<FieldValue>) -> Content {
    Content::Values { values, sequence: None, ticks: None }
}

/// A request that is answered.
pub(crate) fn ask(bytes: Vec<u8>, purpose: Purpose, tag: usize) -> Request {
    Request { bytes, purpose, tag, answered: true }
}

/// A request that nobody answers.
pub(crate) fn tell(bytes: Vec<u8>, purpose: Purpose) -> Request {
    Request { bytes, purpose, tag: 0, answered: false }
}

/// The first line of `bytes`, without and with its terminator; none while it is open.
pub(crate) fn first_line(bytes: &[u8], is_end: impl Fn(u8) -> bool) -> Option<(&[u8], usize)> {
    let end = bytes.iter().position(|byte| is_end(*byte))?;
    Some((&bytes[..end], end + 1))
}

/// A decimal number as instruments write it: digits with a sign and one point, nothing else.
pub(crate) fn decimal(text: &[u8]) -> Option<f64> {
    let text = str::from_utf8(text).ok()?.trim_matches(' ');
    let plain = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    if !plain || !text.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    text.parse().ok().filter(|number: &f64| number.is_finite())
}
