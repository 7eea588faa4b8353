//! MANTRABUS-II: the binary protocol of Mantracourt's digitisers.
//!
//! DSC user manual pp. 53-54. Every data byte travels as two nibbles, and `FE` is sent by the host
//! alone. The last data nibble that the host writes carries bit 7, answers carry no such mark, and
//! a wrong check sum is answered by silence.

use serde::Deserialize;

use super::{
    Content, Damage, Found, Protocol, Purpose, Request, SettingsError, ask, mantracourt, plain,
    settings, value,
};
use crate::Quality;

const START: u8 = 0xFE;
const MARK: u8 = 0x80;
const ACCEPTED: u8 = 0x06;
const REFUSED: u8 = 0x15;
/// Station, eight nibbles of a float, two of the check sum.
const REPLY_BYTES: usize = 11;

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    #[serde(default = "station_one")]
    pub(crate) stations: Vec<u8>,
    /// Number of the parameter that is read, from the manual's table.
    pub(crate) command: u8,
    /// Number of the parameter `VER`, so that each station is asked who it is.
    #[serde(default)]
    pub(crate) version_command: Option<u8>,
    /// Parameters that are set when the port opens, such as the filter's `FFST` to 0.
    #[serde(default)]
    pub(crate) set_up: Vec<Setting>,
}

/// One parameter and its value.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Setting {
    command: u8,
    value: f32,
}

fn station_one() -> Vec<u8> {
    vec![1]
}

struct Mantrabus {
    settings: Settings,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    if settings.stations.is_empty() {
        return Err(SettingsError("stations is empty".to_owned()));
    }
    if let Some(station) = settings.stations.iter().find(|station| !(1..=0xFD).contains(*station)) {
        return Err(SettingsError(format!("station {station}, allowed are 1 to 253")));
    }
    let set_up = settings.set_up.iter().map(|setting| setting.command);
    let mut commands = set_up.chain(settings.version_command).chain([settings.command]);
    if let Some(command) = commands.find(|command| *command >= MARK) {
        return Err(SettingsError(format!("command {command}, allowed are 0 to 127")));
    }
    Ok(Box::new(Mantrabus { settings }))
}

/// XOR of all bytes after `FE`, as two nibbles.
pub(crate) fn checksum(bytes: &[u8]) -> [u8; 2] {
    let check = bytes.iter().fold(0, |check, byte| check ^ byte);
    [check >> 4, check & 0x0F]
}

/// A float as eight nibbles, high first; the last carries the end mark.
pub(crate) fn to_nibbles(number: f32, end: bool) -> [u8; 8] {
    let mut nibbles = [0; 8];
    for (index, byte) in number.to_be_bytes().into_iter().enumerate() {
        nibbles[2 * index] = byte >> 4;
        nibbles[2 * index + 1] = byte & 0x0F;
    }
    nibbles[7] |= if end { MARK } else { 0 };
    nibbles
}

/// The float of eight nibbles.
pub(crate) fn from_nibbles(nibbles: &[u8]) -> Option<f32> {
    let mut bytes = [0; 4];
    for (index, byte) in bytes.iter_mut().enumerate() {
        let (high, low) = (*nibbles.get(2 * index)?, *nibbles.get(2 * index + 1)?);
        if high > 0x0F || low > 0x0F {
            return None;
        }
        *byte = high << 4 | low;
    }
    Some(f32::from_be_bytes(bytes))
}

/// `FE`, station, command with the read mark, check sum.
pub(crate) fn read(station: u8, command: u8) -> Vec<u8> {
    let [high, low] = checksum(&[station, command | MARK]);
    vec![START, station, command | MARK, high, low]
}

/// `FE`, station, command, the number, check sum.
fn write(station: u8, command: u8, number: f32) -> Vec<u8> {
    let mut bytes = vec![station, command];
    bytes.extend(to_nibbles(number, true));
    bytes.extend(checksum(&bytes));
    bytes.insert(0, START);
    bytes
}

impl Protocol for Mantrabus {
    fn fields(&self) -> Vec<String> {
        let command = self.settings.command;
        self.settings.stations.iter().map(|station| format!("{station}:{command}")).collect()
    }

    fn stations(&self) -> Vec<u16> {
        self.settings.stations.iter().map(|station| u16::from(*station)).collect()
    }

    fn opening(&self) -> Vec<Request> {
        let mut requests = Vec::new();
        for (tag, station) in self.settings.stations.iter().enumerate() {
            let version = self.settings.version_command.map(|command| read(*station, command));
            requests.extend(version.map(|bytes| ask(bytes, Purpose::Identify, tag)));
            for Setting { command, value } in &self.settings.set_up {
                requests.push(ask(write(*station, *command, *value), Purpose::Configure, tag));
            }
        }
        requests
    }

    fn cycle(&self) -> Vec<Request> {
        let stations = self.settings.stations.iter().enumerate();
        stations
            .map(|(tag, station)| ask(read(*station, self.settings.command), Purpose::Read, tag))
            .collect()
    }

    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found {
        let (purpose, tag) = asked.map_or((Purpose::Read, 0), |asked| (asked.purpose, asked.tag));
        let Some(station) = self.settings.stations.get(tag) else {
            return Found::Noise { n_bytes: 1, damage: Damage::Form };
        };
        if bytes[0] != *station {
            let other = self.settings.stations.contains(&bytes[0]);
            let damage = if other { Damage::WrongStation } else { Damage::Form };
            return Found::Noise { n_bytes: 1, damage };
        }
        match bytes.get(1) {
            None => return Found::Part,
            Some(&REFUSED) => {
                let content = Content::Refused("NAK".to_owned());
                return Found::Frame { n_bytes: 2, content };
            }
            // A reading may begin with this nibble too.
            Some(&ACCEPTED) if purpose == Purpose::Configure => {
                return Found::Frame { n_bytes: 2, content: Content::Accepted };
            }
            Some(_) => {}
        }
        // A byte that is no nibble ends the attempt before the length is reached.
        let body = &bytes[1..bytes.len().min(REPLY_BYTES)];
        if body.iter().any(|byte| *byte > 0x0F) {
            return Found::Noise { n_bytes: 1, damage: Damage::Form };
        }
        let Some(frame) = bytes.get(..REPLY_BYTES) else { return Found::Part };
        if frame[9..] != checksum(&frame[..9]) {
            return Found::Noise { n_bytes: 1, damage: Damage::Checksum };
        }
        match from_nibbles(&frame[1..9]).filter(|number| number.is_finite()) {
            Some(number) if purpose == Purpose::Identify => {
                let content = Content::Identity(mantracourt::version(f64::from(number)));
                Found::Frame { n_bytes: REPLY_BYTES, content }
            }
            Some(number) => {
                let content = plain(vec![value(tag, f64::from(number), Quality::GOOD)]);
                Found::Frame { n_bytes: REPLY_BYTES, content }
            }
            None => Found::Noise { n_bytes: REPLY_BYTES, damage: Damage::Form },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REPLY: [u8; 11] = [0x14, 0x0C, 0x06, 0x04, 0x00, 0x0E, 0x06, 0x0B, 0x06, 0x01, 0x0F];

    fn bus() -> Box<dyn Protocol> {
        open(&"stations = [20]\ncommand = 40".parse().unwrap()).unwrap()
    }

    #[test]
    fn the_manuals_read_of_gain_is_written() {
        assert_eq!(read(20, 40), [0xFE, 0x14, 0xA8, 0x0B, 0x0C]);
    }

    #[test]
    fn the_manuals_number_travels_as_its_nibbles() {
        let nibbles = [0x0C, 0x06, 0x04, 0x00, 0x0E, 0x06, 0x0B, 0x06];
        assert_eq!(to_nibbles(-12345.678, false), nibbles);
        assert_eq!(from_nibbles(&nibbles), Some(-12345.678));
    }

    #[test]
    fn the_manuals_write_of_gain_is_written_and_its_acknowledgement_read() {
        let text = "stations = [20]\ncommand = 40\nset_up = [{ command = 40, value = 100.0 }]";
        let mut bus = open(&text.parse().unwrap()).unwrap();
        let asked = bus.opening()[0].clone();
        let bytes = [0xFE, 0x14, 0x28, 4, 2, 0x0C, 8, 0, 0, 0, 0x80, 0x0B, 0x0E];
        assert_eq!(asked.bytes, bytes);
        let accepted = Found::Frame { n_bytes: 2, content: Content::Accepted };
        assert_eq!(bus.decode(&[0x14, 0x06], Some(&asked)), accepted);
        // The same bytes are the beginning of a reading when one was asked for.
        assert_eq!(bus.decode(&[0x14, 0x06], Some(&bus.cycle()[0])), Found::Part);
    }

    #[test]
    fn a_cell_that_is_asked_says_its_version() {
        let text = "stations = [20]\ncommand = 40\nversion_command = 5";
        let mut bus = open(&text.parse().unwrap()).unwrap();
        let asked = bus.opening()[0].clone();
        assert_eq!(asked.bytes, read(20, 5));
        let mut reply = vec![20];
        reply.extend(to_nibbles(769.0, false));
        reply.extend(checksum(&reply));
        let content = Content::Identity("Mantracourt version 3.1".to_owned());
        assert_eq!(bus.decode(&reply, Some(&asked)), Found::Frame { n_bytes: 11, content });
    }

    #[test]
    fn the_manuals_answer_is_read() {
        let mut bus = bus();
        let content = plain(vec![value(0, f64::from(-12345.678f32), Quality::GOOD)]);
        assert_eq!(bus.decode(&REPLY, None), Found::Frame { n_bytes: 11, content });
        let content = Content::Refused("NAK".to_owned());
        assert_eq!(bus.decode(&[0x14, 0x15], None), Found::Frame { n_bytes: 2, content });
        assert_eq!(bus.decode(&REPLY[..10], None), Found::Part);
    }

    #[test]
    fn any_bit_flipped_in_an_answer_is_seen() {
        for bit in 8..88 {
            let mut reply = REPLY;
            reply[bit / 8] ^= 1 << (bit % 8);
            let found = bus().decode(&reply, None);
            assert!(matches!(found, Found::Noise { .. }), "bit {bit}: {found:?}");
        }
    }
}
