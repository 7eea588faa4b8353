//! HBM/HBK AED, FIT, AD103C and AD104 digitisers, measured values in binary.
//!
//! AD104 operating manual: output formats COF0, 2, 4, 6, 8 and 12. CR and LF occur inside values
//! too, so frames are counted, not split. Before a value is believed after noise, the frame that
//! follows it must stand where it should. The formats without CR LF (plus 32) are refused: their
//! XOR check is the same in every rotation, so after one lost byte a slow signal reads as another.

use serde::Deserialize;

use super::hbm_line::{self, SetUp, is_overflow, signed_24};
use super::{
    Content, Damage, Found, Protocol, Purpose, Request, SettingsError, plain, settings, tell, value,
};
use crate::Quality;

const WITHOUT_CRLF: u8 = 32;
/// Frames in a row that must fit before the first is believed.
const LOCK_FRAMES: usize = 2;
/// Frame length and text answers stay below this [bytes].
const LINE_BYTES_MAX: usize = 64;

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    /// Number of the output format, such as 8.
    pub(crate) format: u8,
    /// `CSM1`: the fourth byte of formats 8 and 12 is the XOR of the other three.
    #[serde(default)]
    pub(crate) checked: bool,
    #[serde(default)]
    pub(crate) set_up: SetUp,
}

/// How a value lies in its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Format {
    /// 2 or 4.
    n_value_bytes: usize,
    low_first: bool,
    has_check: bool,
}

impl Format {
    /// The format of that number, with the fourth byte as a check or not.
    pub(crate) fn new(number: u8, checked: bool) -> Result<Self, SettingsError> {
        if number & WITHOUT_CRLF != 0 {
            let (why, use_instead) = ("a lost byte would go unnoticed", number & !WITHOUT_CRLF);
            return Err(SettingsError(format!(
                "format {number} is without CR LF, so {why}: use format {use_instead}"
            )));
        }
        let (n_value_bytes, low_first) = match number {
            0 | 8 => (4, false),
            2 => (2, false),
            4 | 12 => (4, true),
            6 => (2, true),
            _ => {
                let known = "known are 0, 2, 4, 6, 8 and 12";
                return Err(SettingsError(format!("format {number}, {known}")));
            }
        };
        Ok(Self { n_value_bytes, low_first, has_check: checked && number & 8 != 0 })
    }

    pub(crate) fn n_bytes(self) -> usize {
        self.n_value_bytes + 2
    }

    /// The value of one frame; `Err` when it is none.
    pub(crate) fn read(self, frame: &[u8]) -> Result<(i32, Quality), Damage> {
        let (body, end) = frame.split_at_checked(self.n_value_bytes).ok_or(Damage::Form)?;
        if end != b"\r\n" {
            return Err(Damage::Form);
        }
        let mut bytes = [0; 4];
        bytes[..body.len()].copy_from_slice(body);
        if self.low_first {
            bytes[..body.len()].reverse();
        }
        let [high, middle, low, last] = bytes;
        if self.n_value_bytes == 2 {
            let raw = i16::from_be_bytes([high, middle]);
            let over = raw == i16::MIN || raw == i16::MAX;
            return Ok((i32::from(raw), Quality::GOOD.with_if(over, Quality::OVER_RANGE)));
        }
        if self.has_check && last != high ^ middle ^ low {
            return Err(Damage::Checksum);
        }
        let raw = signed_24(high, middle, low);
        Ok((raw, Quality::GOOD.with_if(is_overflow(raw), Quality::OVER_RANGE)))
    }

    /// A frame as the digitiser writes it, with status 0 where there is no check.
    pub(crate) fn write(self, raw: i32) -> Vec<u8> {
        let mut bytes = if self.n_value_bytes == 2 {
            let held = raw.clamp(i32::from(i16::MIN), i32::from(i16::MAX));
            (held as i16).to_be_bytes().to_vec()
        } else {
            let [_, high, middle, low] = raw.clamp(-8_388_608, 8_388_607).to_be_bytes();
            let check = if self.has_check { high ^ middle ^ low } else { 0 };
            vec![high, middle, low, check]
        };
        if self.low_first {
            bytes.reverse();
        }
        bytes.extend(b"\r\n");
        bytes
    }
}

struct HbmBinary {
    settings: Settings,
    format: Format,
    /// The last frame stood where it should, so the next needs no witness.
    locked: bool,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    settings.set_up.check()?;
    let format = Format::new(settings.format, settings.checked)?;
    Ok(Box::new(HbmBinary { settings, format, locked: false }))
}

impl HbmBinary {
    fn stream(&mut self, bytes: &[u8]) -> Found {
        let n_bytes = self.format.n_bytes();
        let needed = if self.locked { 1 } else { LOCK_FRAMES };
        for frame in bytes.chunks(n_bytes).take(needed) {
            if frame.len() < n_bytes {
                return Found::Part;
            }
            if let Err(damage) = self.format.read(frame) {
                self.locked = false;
                return Found::Noise { n_bytes: 1, damage };
            }
        }
        if bytes.len() < needed * n_bytes {
            return Found::Part;
        }
        match self.format.read(&bytes[..n_bytes]) {
            Ok((raw, quality)) => {
                self.locked = true;
                let content = plain(vec![value(0, f64::from(raw), quality)]);
                Found::Frame { n_bytes, content }
            }
            Err(damage) => Found::Noise { n_bytes: 1, damage },
        }
    }
}

impl Protocol for HbmBinary {
    fn fields(&self) -> Vec<String> {
        vec!["MSV".to_owned()]
    }

    fn opening(&self) -> Vec<Request> {
        let mut requests = self.settings.set_up.opening(&[], self.settings.format);
        if self.settings.checked {
            requests.push(super::ask(b"CSM1;".to_vec(), Purpose::Configure, 0));
        }
        requests.push(tell(b"MSV?0;".to_vec(), Purpose::Configure));
        requests
    }

    fn cycle(&self) -> Vec<Request> {
        Vec::new()
    }

    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found {
        let Some(asked) = asked else { return self.stream(bytes) };
        // The answers to the set-up come in text, before the values.
        self.locked = false;
        let Some((line, n_bytes)) = hbm_line::line(bytes) else {
            if bytes.len() > LINE_BYTES_MAX {
                return Found::Noise { n_bytes: bytes.len() - 1, damage: Damage::TooLong };
            }
            return Found::Part;
        };
        match hbm_line::answer(line, asked.purpose) {
            // What was still streaming when `STP;` came is no identity.
            Some(Content::Identity(_)) if line.iter().any(u8::is_ascii_control) => {
                Found::Skip { n_bytes }
            }
            Some(content) => Found::Frame { n_bytes, content },
            None => Found::Skip { n_bytes },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checked_examples_are_read_and_written() {
        let format = Format::new(8, true).unwrap();
        let examples = [
            (1, [0x00, 0x00, 0x01, 0x01]),
            (-1, [0xFF, 0xFF, 0xFF, 0xFF]),
            (123_456, [0x01, 0xE2, 0x40, 0xA3]),
            (-123_456, [0xFE, 0x1D, 0xC0, 0x23]),
            (1_000_000, [0x0F, 0x42, 0x40, 0x0D]),
            (-1_000_000, [0xF0, 0xBD, 0xC0, 0x8D]),
        ];
        for (raw, bytes) in examples {
            let frame = [&bytes[..], b"\r\n"].concat();
            assert_eq!(format.read(&frame), Ok((raw, Quality::GOOD)));
            assert_eq!(format.write(raw), frame);
        }
        assert_eq!(format.read(b"\x0F\x42\x41\x0D\r\n"), Err(Damage::Checksum));
    }

    #[test]
    fn the_formats_have_the_manuals_lengths() {
        let lengths = [(0, 6), (2, 4), (4, 6), (6, 4), (8, 6), (12, 6)];
        for (number, n_bytes) in lengths {
            let format = Format::new(number, true).unwrap();
            assert_eq!(format.n_bytes(), n_bytes);
            assert_eq!(format.read(&format.write(-1234)).unwrap().0, -1234);
        }
        let error = Format::new(40, true).unwrap_err().to_string();
        assert!(error.contains("without CR LF") && error.contains("use format 8"), "{error}");
        assert!(Format::new(3, false).is_err());
    }

    #[test]
    fn line_ends_inside_values_split_nothing() {
        let mut binary = open(&"format = 0".parse().unwrap()).unwrap();
        // 0x0D0A0D and its neighbours look like line ends wherever one looks.
        let raws = [0x000D_0A0D, 0x000A_0D0A, 0x000D_0A0D, -1, 5];
        let format = Format::new(0, false).unwrap();
        let bytes: Vec<u8> = raws.iter().flat_map(|raw| format.write(*raw)).collect();
        let mut at = 0;
        let mut read = Vec::new();
        while let Found::Frame { n_bytes, content } = binary.decode(&bytes[at..], None) {
            at += n_bytes;
            let Content::Values { values, .. } = content else { panic!("values") };
            read.push(values[0].raw as i32);
            if at == bytes.len() {
                break;
            }
        }
        assert_eq!(read, raws);
    }

    #[test]
    fn over_driven_inputs_are_flagged() {
        let format = Format::new(0, false).unwrap();
        let over = format.read(&format.write(i32::MIN)).unwrap();
        assert_eq!(over, (-8_388_608, Quality::OVER_RANGE));
    }
}
