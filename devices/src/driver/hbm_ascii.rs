//! HBM/HBK AED, FIT, AD103C and AD104 digitisers, measured values in text.
//!
//! AD104 operating manual: output formats COF3 (eight characters) and COF9 (with address and
//! status), `MSV?;`, and `S98;MSV?;` for a bus whose members all measure at once.

use serde::Deserialize;

use super::hbm_line::{self, SetUp};
use super::{
    Damage, Found, Protocol, Purpose, Request, SettingsError, ask, plain, settings, tell, value,
};
use crate::Quality;

const LINE_BYTES_MAX: usize = 64;

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    /// Bus addresses; empty for one digitiser on its own line.
    #[serde(default)]
    pub(crate) stations: Vec<u8>,
    /// `MSV?0;`: the digitiser sends without being asked, at its own rate.
    #[serde(default)]
    pub(crate) continuous: bool,
    #[serde(default)]
    pub(crate) set_up: SetUp,
}

struct HbmAscii {
    settings: Settings,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    settings.set_up.check()?;
    if settings.continuous && !settings.stations.is_empty() {
        return Err(SettingsError("on a bus nobody may send unasked: continuous".to_owned()));
    }
    if let Some(station) = settings.stations.iter().find(|station| **station > 89) {
        return Err(SettingsError(format!("station {station}, allowed are 0 to 89")));
    }
    Ok(Box::new(HbmAscii { settings }))
}

/// Eight characters (COF3) or `xxxxxxxx,aa,sss` (COF9): the value and the address.
fn measured(line: &[u8]) -> Option<(i32, Option<u8>)> {
    let text = str::from_utf8(line).ok()?;
    let mut parts = text.split(',');
    let number = parts.next()?.trim();
    let digits = number.strip_prefix(['+', '-']).unwrap_or(number);
    let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    let raw: i32 = number.parse().ok().filter(|_| plain)?;
    let address = match parts.next() {
        Some(address) => Some(address.trim().parse().ok()?),
        None if line.len() == 8 => None,
        None => return None,
    };
    Some((raw, address))
}

impl Protocol for HbmAscii {
    fn fields(&self) -> Vec<String> {
        if self.settings.stations.is_empty() {
            return vec!["MSV".to_owned()];
        }
        self.settings.stations.iter().map(|station| format!("S{station:02}")).collect()
    }

    fn stations(&self) -> Vec<u16> {
        self.settings.stations.iter().map(|station| u16::from(*station)).collect()
    }

    fn opening(&self) -> Vec<Request> {
        let mut requests = self.settings.set_up.opening(&self.settings.stations, 3);
        if self.settings.continuous {
            requests.push(tell(b"MSV?0;".to_vec(), Purpose::Configure));
        }
        requests
    }

    fn cycle(&self) -> Vec<Request> {
        if self.settings.continuous {
            return Vec::new();
        }
        if self.settings.stations.is_empty() {
            return vec![ask(b"MSV?;".to_vec(), Purpose::Read, 0)];
        }
        let fetch = |(tag, station): (usize, &u8)| {
            ask(format!("S{station:02};").into_bytes(), Purpose::Read, tag)
        };
        let mut requests = vec![tell(b"S98;MSV?;".to_vec(), Purpose::Hold)];
        requests.extend(self.settings.stations.iter().enumerate().map(fetch));
        requests
    }

    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found {
        let Some((line, n_bytes)) = hbm_line::line(bytes) else {
            if bytes.len() > LINE_BYTES_MAX {
                return Found::Noise { n_bytes: bytes.len() - 1, damage: Damage::TooLong };
            }
            return Found::Part;
        };
        if line.is_empty() {
            return Found::Skip { n_bytes };
        }
        let (purpose, tag) = asked.map_or((Purpose::Read, 0), |asked| (asked.purpose, asked.tag));
        if let Some(content) = hbm_line::answer(line, purpose) {
            return Found::Frame { n_bytes, content };
        }
        let Some((raw, address)) = measured(line) else {
            return Found::Noise { n_bytes, damage: Damage::Form };
        };
        let due = self.settings.stations.get(tag);
        if let (Some(address), Some(due)) = (address, due)
            && address != *due
        {
            return Found::Noise { n_bytes, damage: Damage::WrongStation };
        }
        let quality = Quality::GOOD.with_if(hbm_line::is_overflow(raw), Quality::OVER_RANGE);
        let field = if due.is_some() { tag } else { 0 };
        let content = plain(vec![value(field, f64::from(raw), quality)]);
        Found::Frame { n_bytes, content }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::Content;

    fn digitiser(settings: &str) -> Box<dyn Protocol> {
        open(&settings.parse().unwrap()).unwrap()
    }

    #[test]
    fn eight_characters_are_a_value_and_too_low_is_over_range() {
        let mut one = digitiser("");
        let asked = one.cycle()[0].clone();
        assert_eq!(asked.bytes, b"MSV?;");
        let content = plain(vec![value(0, 123_456.0, Quality::GOOD)]);
        let found = one.decode(b" 0123456\r\n", Some(&asked));
        assert_eq!(found, Found::Frame { n_bytes: 10, content });
        let content = plain(vec![value(0, -8_388_608.0, Quality::OVER_RANGE)]);
        let found = one.decode(b"-8388608\r\n", Some(&asked));
        assert_eq!(found, Found::Frame { n_bytes: 10, content });
        let found = one.decode(b"012345\r\n", Some(&asked));
        assert_eq!(found, Found::Noise { n_bytes: 8, damage: Damage::Form });
    }

    #[test]
    fn the_start_flushes_identifies_and_sets_up() {
        let digitiser = digitiser("set_up.commands = [\"ASF0\", \"ICR0\"]");
        let sent: Vec<Vec<u8>> =
            digitiser.opening().into_iter().map(|request| request.bytes).collect();
        assert_eq!(sent, [&b"STP;"[..], b"IDN?;", b"ASF0;", b"ICR0;", b"COF3;"]);
    }

    #[test]
    fn a_bus_measures_at_once_and_is_fetched_by_address() {
        let mut bus = digitiser("stations = [1, 2]");
        let cycle = bus.cycle();
        let sent: Vec<&[u8]> = cycle.iter().map(|request| &request.bytes[..]).collect();
        assert_eq!(sent, [&b"S98;MSV?;"[..], b"S01;", b"S02;"]);
        let found = bus.decode(b"-0001234,01,000\r\n", Some(&cycle[2]));
        assert_eq!(found, Found::Noise { n_bytes: 17, damage: Damage::WrongStation });
        let content = plain(vec![value(1, -1234.0, Quality::GOOD)]);
        let found = bus.decode(b"-0001234,02,000\r\n", Some(&cycle[2]));
        assert_eq!(found, Found::Frame { n_bytes: 17, content });
    }

    #[test]
    fn a_refused_set_up_is_told() {
        let mut digitiser = digitiser("");
        let format = digitiser.opening()[2].clone();
        let accepted = Found::Frame { n_bytes: 3, content: Content::Accepted };
        assert_eq!(digitiser.decode(b"0\r\n", Some(&format)), accepted);
        let content = Content::Refused("?".to_owned());
        assert_eq!(digitiser.decode(b"?\r\n", Some(&format)), Found::Frame { n_bytes: 3, content });
    }
}
