//! Mantracourt ASCII: DSC, `DCell` and DSCUSB load-cell digitisers.
//!
//! DSC user manual, appendix B; DSCUSB advanced manual p. 19. There is no check sum, so an answer's
//! form is held to strictly. `OLDVAL` in `STAT` tells a conversion that was read before.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::{
    Content, Damage, Found, Protocol, Purpose, Request, SettingsError, ask, decimal, first_line,
    plain, settings, tell, value,
};
use crate::Quality;

/// Longest answer: sign, 15 digits and a point.
const REPLY_BYTES_MAX: usize = 20;
/// Bits of `STAT`: over- and under-ranges of input, cell, raw and system values.
const STAT_RANGE: u32 = 0b0111_1111_0010;
const STAT_BRIDGE: u32 = 1 << 11;
const STAT_SHUNT: u32 = 1 << 12;
const STAT_OLD: u32 = 1 << 13;

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    #[serde(default = "station_one")]
    pub(crate) stations: Vec<u16>,
    /// Identifier of the reading: `SYS`, `MVV`, `CELL` ...
    #[serde(default = "system_output")]
    pub(crate) read: String,
    /// All stations measure at `SNAP`, and `SYSN` is read.
    #[serde(default)]
    pub(crate) snapshot: bool,
    /// `STAT` is read before each reading, for its quality and repeats.
    #[serde(default)]
    pub(crate) status: bool,
    /// Parameters that are set when the port opens, such as `FFST = 0`: no filter.
    #[serde(default)]
    pub(crate) set_up: BTreeMap<String, f64>,
}

fn station_one() -> Vec<u16> {
    vec![1]
}

fn system_output() -> String {
    "SYS".to_owned()
}

struct Mantracourt {
    settings: Settings,
    /// What each station's last `STAT` said of its next reading.
    quality: Vec<Quality>,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    if settings.stations.is_empty() {
        return Err(SettingsError("stations is empty".to_owned()));
    }
    if let Some(station) = settings.stations.iter().find(|station| !(1..=999).contains(*station)) {
        return Err(SettingsError(format!("station {station}, allowed are 1 to 999")));
    }
    let fits = |name: &str| {
        (1..=4).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_alphanumeric())
    };
    if let Some(name) = settings.set_up.keys().chain([&settings.read]).find(|name| !fits(name)) {
        return Err(SettingsError(format!("\"{name}\": an identifier has 1 to 4 letters")));
    }
    let quality = vec![Quality::GOOD; settings.stations.len()];
    Ok(Box::new(Mantracourt { settings, quality }))
}

/// `!001:SYS?` with its carriage return; station 0 is everyone.
pub(crate) fn query(station: u16, identifier: &str) -> Vec<u8> {
    format!("!{station:03}:{identifier}?\r").into_bytes()
}

/// `!014:RST` with its carriage return.
pub(crate) fn action(station: u16, identifier: &str) -> Vec<u8> {
    format!("!{station:03}:{identifier}\r").into_bytes()
}

/// `!001:SGAI=123.456` with its carriage return.
pub(crate) fn write(station: u16, identifier: &str, value: f64) -> Vec<u8> {
    format!("!{station:03}:{identifier}={value}\r").into_bytes()
}

/// The value of `VER` in words.
pub(super) fn version(value: f64) -> String {
    let (high, low) = ((value / 256.0).floor(), value.rem_euclid(256.0).floor());
    format!("Mantracourt version {high}.{low}")
}

impl Mantracourt {
    fn value(&self, tag: usize, text: &[u8]) -> Option<Content> {
        let signed = matches!(text.first(), Some(b'+' | b'-'));
        let raw = decimal(text).filter(|_| signed)?;
        Some(plain(vec![value(tag, raw, self.quality[tag])]))
    }

    fn status(&mut self, tag: usize, text: &[u8]) -> Option<Content> {
        let bits = decimal(text).filter(|bits| (0.0..65_536.0).contains(bits))? as u32;
        self.quality[tag] = Quality::GOOD
            .with_if(bits & STAT_RANGE != 0, Quality::OVER_RANGE)
            .with_if(bits & STAT_BRIDGE != 0, Quality::SENSOR_FAULT)
            .with_if(bits & STAT_SHUNT != 0, Quality::CALIBRATING)
            .with_if(bits & STAT_OLD != 0, Quality::REPEATED);
        Some(Content::Accepted)
    }
}

impl Protocol for Mantracourt {
    fn fields(&self) -> Vec<String> {
        let read = &self.settings.read;
        self.settings.stations.iter().map(|station| format!("{station:03}:{read}")).collect()
    }

    fn stations(&self) -> Vec<u16> {
        self.settings.stations.clone()
    }

    fn opening(&self) -> Vec<Request> {
        let mut requests = Vec::new();
        for (tag, station) in self.settings.stations.iter().enumerate() {
            requests.push(ask(query(*station, "VER"), Purpose::Identify, tag));
            for (identifier, value) in &self.settings.set_up {
                requests.push(ask(write(*station, identifier, *value), Purpose::Configure, tag));
            }
        }
        requests
    }

    fn cycle(&self) -> Vec<Request> {
        let mut requests = Vec::new();
        let read = if self.settings.snapshot {
            requests.push(tell(action(0, "SNAP"), Purpose::Hold));
            "SYSN"
        } else {
            &self.settings.read
        };
        for (tag, station) in self.settings.stations.iter().enumerate() {
            if self.settings.status {
                requests.push(ask(query(*station, "STAT"), Purpose::Status, tag));
            }
            requests.push(ask(query(*station, read), Purpose::Read, tag));
        }
        requests
    }

    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found {
        let Some((text, n_bytes)) = first_line(bytes, |byte| byte == b'\r') else {
            if bytes.len() > REPLY_BYTES_MAX {
                return Found::Noise { n_bytes: bytes.len(), damage: Damage::TooLong };
            }
            return Found::Part;
        };
        let (purpose, tag) = asked.map_or((Purpose::Read, 0), |asked| (asked.purpose, asked.tag));
        let content = match (text, purpose) {
            (b"?", _) => Some(Content::Refused("?".to_owned())),
            (b"", _) => Some(Content::Accepted),
            (_, Purpose::Status) => self.status(tag, text),
            (_, Purpose::Identify) => decimal(text).map(|value| Content::Identity(version(value))),
            _ => self.value(tag, text),
        };
        match content {
            Some(content) => Found::Frame { n_bytes, content },
            None => Found::Noise { n_bytes, damage: Damage::Form },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(settings: &str) -> Box<dyn Protocol> {
        open(&settings.parse().unwrap()).unwrap()
    }

    #[test]
    fn the_manuals_requests_are_written() {
        let sys = [0x21, 0x30, 0x30, 0x31, 0x3A, 0x53, 0x59, 0x53, 0x3F, 0x0D];
        assert_eq!(query(1, "SYS"), sys);
        let reset = [0x21, 0x30, 0x31, 0x34, 0x3A, 0x52, 0x53, 0x54, 0x0D];
        assert_eq!(action(14, "RST"), reset);
        let snap = [0x21, 0x30, 0x30, 0x30, 0x3A, 0x53, 0x4E, 0x41, 0x50, 0x0D];
        assert_eq!(action(0, "SNAP"), snap);
    }

    #[test]
    fn the_manuals_answers_are_read() {
        let mut cell = cell("");
        let asked = cell.cycle()[0].clone();
        let reply = [0x2B, 0x30, 0x30, 0x30, 0x33, 0x32, 0x2E, 0x31, 0x30, 0x30, 0x0D];
        let content = plain(vec![value(0, 32.1, Quality::GOOD)]);
        assert_eq!(cell.decode(&reply, Some(&asked)), Found::Frame { n_bytes: 11, content });
        let baud = [0x2B, 0x30, 0x30, 0x30, 0x30, 0x37, 0x0D];
        let content = plain(vec![value(0, 7.0, Quality::GOOD)]);
        assert_eq!(cell.decode(&baud, Some(&asked)), Found::Frame { n_bytes: 7, content });
        let content = Content::Refused("?".to_owned());
        assert_eq!(cell.decode(&[0x3F, 0x0D], Some(&asked)), Found::Frame { n_bytes: 2, content });
        let accepted = Found::Frame { n_bytes: 1, content: Content::Accepted };
        assert_eq!(cell.decode(&[0x0D], Some(&asked)), accepted);
    }

    #[test]
    fn the_manuals_write_of_gain_is_written_and_its_answer_read() {
        let mut cell = cell("set_up = { SGAI = 123.456 }");
        let asked = cell.opening()[1].clone();
        let gain = [
            0x21, 0x30, 0x30, 0x31, 0x3A, 0x53, 0x47, 0x41, 0x49, 0x3D, 0x31, 0x32, 0x33, 0x2E,
            0x34, 0x35, 0x36, 0x0D,
        ];
        assert_eq!(asked.bytes, gain);
        let accepted = Found::Frame { n_bytes: 1, content: Content::Accepted };
        assert_eq!(cell.decode(&[0x0D], Some(&asked)), accepted);
    }

    #[test]
    fn a_malformed_number_is_no_reading() {
        let mut cell = cell("");
        for text in [&b"00032.1\r"[..], b"+0003 2.1\r", b"+\r", b"+1.2.3\r", b"+inf\r"] {
            let found = cell.decode(text, None);
            assert_eq!(found, Found::Noise { n_bytes: text.len(), damage: Damage::Form });
        }
    }

    #[test]
    fn a_snapshot_asks_everyone_at_once_and_status_marks_old_values() {
        let mut cell = cell("stations = [1, 2]\nsnapshot = true\nstatus = true");
        let cycle = cell.cycle();
        let sent: Vec<&[u8]> = cycle.iter().map(|request| &request.bytes[..]).collect();
        let expected: [&[u8]; 5] =
            [b"!000:SNAP\r", b"!001:STAT?\r", b"!001:SYSN?\r", b"!002:STAT?\r", b"!002:SYSN?\r"];
        assert_eq!(sent, expected);
        cell.decode(b"+08192.\r", Some(&cycle[3]));
        let Found::Frame { content: Content::Values { values, .. }, .. } =
            cell.decode(b"-00001.5\r", Some(&cycle[4]))
        else {
            panic!("a value");
        };
        assert_eq!(values, [value(1, -1.5, Quality::REPEATED)]);
    }
}
