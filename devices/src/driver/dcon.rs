//! DCON: Advantech ADAM-4000 and ICP DAS I-7000 modules.
//!
//! ADAM-4000 user manual, chapter 4. With check sums switched on, an answer without its sum taken
//! off would still read as a longer number, so lengths are held to, and `$AA2` says at the start
//! whether module and settings agree.

use serde::Deserialize;

use super::{
    Content, Damage, FieldValue, Found, Protocol, Purpose, Request, SettingsError, ask, decimal,
    first_line, plain, settings, tell, value,
};
use crate::Quality;

/// One channel in engineering form: sign, five digits and a point.
const CHANNEL_BYTES: usize = 7;
/// One channel in two's complement: four hexadecimal digits.
const HEX_BYTES: usize = 4;
const REPLY_BYTES_MAX: usize = 80;
const OVER: &[u8] = b"+999999";
const UNDER: &[u8] = b"-000000";

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    pub(crate) modules: Vec<Module>,
    #[serde(default)]
    pub(crate) checksum: bool,
    /// All modules measure at `#**`, and `$AA4` is read: one channel a module.
    #[serde(default)]
    pub(crate) synchronised: bool,
    /// Data in two's-complement hexadecimal, whose full scale is 7FFF.
    #[serde(default)]
    pub(crate) hexadecimal: bool,
}

/// One module on the bus.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Module {
    pub(crate) address: u8,
    /// Channels fetched by `#AAN`; none fetches all that are enabled by `#AA`.
    #[serde(default)]
    pub(crate) channel: Option<u8>,
    /// How many channels answer `#AA`.
    #[serde(default = "one")]
    pub(crate) channels: usize,
}

fn one() -> usize {
    1
}

struct Dcon {
    settings: Settings,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    if settings.modules.is_empty() {
        return Err(SettingsError("modules is empty".to_owned()));
    }
    for module in &settings.modules {
        let Module { address, channel, channels } = module;
        if !(1..=8).contains(channels) || channel.is_some_and(|channel| channel > 7) {
            return Err(SettingsError(format!("module {address:02X}: channels are 0 to 7")));
        }
        if (settings.synchronised || channel.is_some()) && *channels != 1 {
            return Err(SettingsError(format!("module {address:02X}: one channel is read so")));
        }
    }
    Ok(Box::new(Dcon { settings }))
}

/// Sum of all characters before the carriage return, two hexadecimal digits.
pub(crate) fn checksum(text: &[u8]) -> [u8; 2] {
    let sum = text.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    let digit = |nibble: u8| b"0123456789ABCDEF"[usize::from(nibble & 0x0F)];
    [digit(sum >> 4), digit(sum)]
}

/// A command or answer with its check sum, when switched on, and its carriage return.
pub(crate) fn framed(text: &str, with_checksum: bool) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    if with_checksum {
        bytes.extend(checksum(text.as_bytes()));
    }
    bytes.push(b'\r');
    bytes
}

impl Dcon {
    fn first_field(&self, tag: usize) -> usize {
        self.settings.modules.iter().take(tag).map(|module| module.channels).sum()
    }

    fn read(&self, module: &Module) -> Vec<u8> {
        let address = module.address;
        let text = match module.channel {
            _ if self.settings.synchronised => format!("${address:02X}4"),
            Some(channel) => format!("#{address:02X}{channel}"),
            None => format!("#{address:02X}"),
        };
        framed(&text, self.settings.checksum)
    }

    /// The answer to `asked`; `Err` says why it is none.
    fn answer(&self, text: &[u8], asked: Option<&Request>) -> Result<Content, Damage> {
        let (purpose, tag) = asked.map_or((Purpose::Read, 0), |asked| (asked.purpose, asked.tag));
        let module = self.settings.modules.get(tag).ok_or(Damage::Form)?;
        let address = format!("{:02X}", module.address);
        let (lead, body) = text.split_first().ok_or(Damage::Form)?;
        let mine = |body: &[u8]| body.get(..2) == Some(address.as_bytes());
        match (lead, purpose) {
            (b'?', _) if mine(body) => Ok(Content::Refused(super::session::shown(text))),
            (b'?' | b'!', _) if !mine(body) => Err(Damage::WrongStation),
            (b'!', Purpose::Identify) => {
                Ok(Content::Identity(String::from_utf8_lossy(&body[2..]).into_owned()))
            }
            (b'!', Purpose::Configure) => self.configuration(&body[2..]),
            (b'>', Purpose::Read) if self.settings.synchronised => {
                let (state, data) = body.split_at_checked(3).ok_or(Damage::Form)?;
                if !mine(state) {
                    return Err(Damage::WrongStation);
                }
                let quality = match state[2] {
                    b'1' => Quality::GOOD,
                    b'0' => Quality::REPEATED,
                    _ => return Err(Damage::Form),
                };
                self.values(data, tag, quality)
            }
            (b'>', Purpose::Read) => self.values(body, tag, Quality::GOOD),
            _ => Err(Damage::Form),
        }
    }

    /// `TTCCFF`: bit 6 of FF is the check sum, its bits 1 and 0 the form of the data.
    fn configuration(&self, body: &[u8]) -> Result<Content, Damage> {
        let text = str::from_utf8(body).ok().filter(|text| text.len() == 6);
        let format = text.and_then(|text| u8::from_str_radix(text.get(4..)?, 16).ok());
        let format = format.ok_or(Damage::Form)?;
        let hexadecimal = format & 0b11 == 0b10;
        let agrees = (format & 0x40 != 0) == self.settings.checksum
            && hexadecimal == self.settings.hexadecimal;
        if agrees {
            return Ok(Content::Accepted);
        }
        let says = format!("data format {format:02X}, which differs from the settings");
        Ok(Content::Refused(says))
    }

    fn values(&self, data: &[u8], tag: usize, quality: Quality) -> Result<Content, Damage> {
        let width = if self.settings.hexadecimal { HEX_BYTES } else { CHANNEL_BYTES };
        let n_channels = self.settings.modules[tag].channels;
        if data.len() != width * n_channels {
            return Err(Damage::Form);
        }
        let first = self.first_field(tag);
        let read = |(index, text): (usize, &[u8])| -> Option<FieldValue> {
            let field = first + index;
            if self.settings.hexadecimal {
                let bits = u16::from_str_radix(str::from_utf8(text).ok()?, 16).ok()?;
                let raw = f64::from(bits.cast_signed());
                let over = bits == 0x7FFF || bits == 0x8000;
                return Some(value(field, raw, quality.with_if(over, Quality::OVER_RANGE)));
            }
            let over = text == OVER || text == UNDER;
            let signed = text[0] == b'+' || text[0] == b'-';
            let raw = decimal(text).filter(|_| signed)?;
            Some(value(field, raw, quality.with_if(over, Quality::OVER_RANGE)))
        };
        let values: Option<Vec<FieldValue>> =
            data.chunks_exact(width).enumerate().map(read).collect();
        values.map(plain).ok_or(Damage::Form)
    }
}

impl Protocol for Dcon {
    fn fields(&self) -> Vec<String> {
        let channels = |module: &Module| {
            let Module { address, channel, channels } = *module;
            let first = usize::from(channel.unwrap_or(0));
            (first..first + channels).map(move |channel| format!("{address:02X}.{channel}"))
        };
        self.settings.modules.iter().flat_map(channels).collect()
    }

    fn stations(&self) -> Vec<u16> {
        self.settings.modules.iter().map(|module| u16::from(module.address)).collect()
    }

    fn opening(&self) -> Vec<Request> {
        let mut requests = Vec::new();
        for (tag, module) in self.settings.modules.iter().enumerate() {
            let to = |command: &str| {
                framed(&format!("${:02X}{command}", module.address), self.settings.checksum)
            };
            requests.push(ask(to("M"), Purpose::Identify, tag));
            requests.push(ask(to("2"), Purpose::Configure, tag));
        }
        requests
    }

    fn cycle(&self) -> Vec<Request> {
        let mut requests = Vec::new();
        if self.settings.synchronised {
            requests.push(tell(framed("#**", self.settings.checksum), Purpose::Hold));
        }
        for (tag, module) in self.settings.modules.iter().enumerate() {
            requests.push(ask(self.read(module), Purpose::Read, tag));
        }
        requests
    }

    fn fields_asked(&self, request: &Request) -> Vec<usize> {
        let first = self.first_field(request.tag);
        let n_channels = self.settings.modules.get(request.tag).map_or(0, |module| module.channels);
        (first..first + n_channels).collect()
    }

    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found {
        let Some((line, n_bytes)) = first_line(bytes, |byte| byte == b'\r') else {
            if bytes.len() > REPLY_BYTES_MAX {
                return Found::Noise { n_bytes: bytes.len(), damage: Damage::TooLong };
            }
            return Found::Part;
        };
        let text = if self.settings.checksum {
            match line.split_last_chunk::<2>() {
                Some((text, sum)) if checksum(text) == *sum => text,
                _ => return Found::Noise { n_bytes, damage: Damage::Checksum },
            }
        } else {
            line
        };
        match self.answer(text, asked) {
            Ok(content) => Found::Frame { n_bytes, content },
            Err(damage) => Found::Noise { n_bytes, damage },
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
mod tests {
    use super::*;

    fn bus(settings: &str) -> Box<dyn Protocol> {
        open(&settings.parse().unwrap()).unwrap()
    }

    /// The values of an answer to the first reading of a cycle.
    fn read(settings: &str, reply: &[u8]) -> Vec<FieldValue> {
        let mut bus = bus(settings);
        let cycle = bus.cycle();
        let asked = cycle.iter().find(|request| request.purpose == Purpose::Read).unwrap();
        match bus.decode(reply, Some(asked)) {
            Found::Frame { content: Content::Values { values, .. }, .. } => values,
            found => panic!("{found:?}"),
        }
    }

    #[test]
    fn the_manuals_readings_are_read() {
        let all = "modules = [{ address = 0x21, channels = 8 }]";
        assert_eq!(bus(all).cycle()[0].bytes, b"#21\r");
        let reply = b">+7.2111+7.2567+7.3125+7.1000+7.4712+7.2555+7.1234+7.5678\r";
        let values: Vec<f64> = read(all, reply).iter().map(|value| value.raw).collect();
        assert_eq!(values, [7.2111, 7.2567, 7.3125, 7.1, 7.4712, 7.2555, 7.1234, 7.5678]);
        let one = "modules = [{ address = 0x12, channel = 0 }]";
        assert_eq!(bus(one).cycle()[0].bytes, b"#120\r");
        assert_eq!(read(one, b">+1.4567\r")[0].raw, 1.4567);
        let five = "modules = [{ address = 3, channel = 5 }]";
        assert_eq!(bus(five).cycle()[0].bytes, b"#035\r");
        assert_eq!(read(five, b">+09.789\r")[0].raw, 9.789);
        let hex = "modules = [{ address = 0xDE }]\nhexadecimal = true";
        assert_eq!(bus(hex).cycle()[0].bytes, b"#DE\r");
        assert_eq!(read(hex, b">FF5D\r")[0].raw, -163.0);
    }

    #[test]
    fn a_synchronised_reading_says_whether_it_is_fresh() {
        let settings = "modules = [{ address = 7 }]\nsynchronised = true";
        let cycle = bus(settings).cycle();
        assert_eq!((&cycle[0].bytes[..], &cycle[1].bytes[..]), (&b"#**\r"[..], &b"$074\r"[..]));
        assert_eq!(read(settings, b">071+5.8222\r"), [value(0, 5.8222, Quality::GOOD)]);
        assert_eq!(read(settings, b">070+5.8222\r"), [value(0, 5.8222, Quality::REPEATED)]);
    }

    #[test]
    fn the_check_sums_are_the_manuals() {
        let sums: [(&str, &[u8]); 13] = [
            ("$012", b"$012B7\r"),
            ("!01200600", b"!01200600AA\r"),
            ("#01", b"#0184\r"),
            ("#010", b"#010B4\r"),
            (">+1.2345", b">+1.234596\r"),
            (">+05.123", b">+05.12392\r"),
            ("$01M", b"$01MD2\r"),
            ("!014017", b"!0140174E\r"),
            ("?01", b"?01A0\r"),
            ("$014", b"$014B9\r"),
            (">011+5.8222", b">011+5.82222C\r"),
            ("%0101080640", b"%010108064019\r"),
            ("!01", b"!0182\r"),
        ];
        for (text, bytes) in sums {
            assert_eq!(framed(text, true), bytes, "{text}");
        }
    }

    #[test]
    fn a_check_sum_that_nobody_expects_is_no_longer_number() {
        let mut plain = bus("modules = [{ address = 1 }]");
        let asked = plain.cycle()[0].clone();
        let found = plain.decode(b">+1.234596\r", Some(&asked));
        assert_eq!(found, Found::Noise { n_bytes: 11, damage: Damage::Form });
        let summed = "modules = [{ address = 1 }]\nchecksum = true";
        assert_eq!(read(summed, b">+1.234596\r")[0].raw, 1.2345);
    }

    #[test]
    fn identity_configuration_and_over_range_are_read() {
        let mut module = bus("modules = [{ address = 1, channel = 0 }]");
        let opening = module.opening();
        let identity = Content::Identity("4017".to_owned());
        let found = module.decode(b"!014017\r", Some(&opening[0]));
        assert_eq!(found, Found::Frame { n_bytes: 8, content: identity });
        let found = module.decode(b"!01050600\r", Some(&opening[1]));
        assert_eq!(found, Found::Frame { n_bytes: 10, content: Content::Accepted });
        // The manual's module 45 in engineering form without check sum.
        let mut manuals = bus("modules = [{ address = 0x45 }]");
        let asked = manuals.opening()[1].clone();
        assert_eq!(asked.bytes, b"$452\r");
        let found = manuals.decode(b"!45050600\r", Some(&asked));
        assert_eq!(found, Found::Frame { n_bytes: 10, content: Content::Accepted });
        let found = module.decode(b"!01050640\r", Some(&opening[1]));
        assert!(matches!(found, Found::Frame { content: Content::Refused(_), .. }), "{found:?}");
        let over = read("modules = [{ address = 1 }]", b">+999999\r");
        assert_eq!(over[0].quality, Quality::OVER_RANGE);
    }
}
