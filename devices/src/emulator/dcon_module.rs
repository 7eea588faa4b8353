//! ADAM-4000 and I-7000 modules on one bus: ADAM-4000 user manual, chapter 4.

use super::heard::Heard;
use super::line_pace::LinePace;
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{DconSettings, dcon_checksum};

const NAME: &str = "4017";

struct DconModules {
    settings: DconSettings,
    pace: LinePace,
    signal: Signal,
    heard: Heard,
    /// What each module holds since `#**`, and whether it was read.
    held: Vec<(f64, bool)>,
}

pub(super) fn open(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read::<DconSettings>()?;
    let held = vec![(0.0, true); settings.modules.len()];
    Ok(Box::new(DconModules { settings, pace, signal, heard: Heard::default(), held }))
}

/// Sign, five digits and a point wherever the size wants it: `+1.4567`, `+09.789`.
fn engineering(value: f64) -> String {
    let n_decimals = match value.abs() {
        size if size < 9.999_95 => 4,
        size if size < 99.9995 => 3,
        size if size < 999.995 => 2,
        _ => return if value > 0.0 { "+999999" } else { "-000000" }.to_owned(),
    };
    format!("{value:+07.n_decimals$}")
}

impl DconModules {
    fn first_field(&self, tag: usize) -> usize {
        self.settings.modules.iter().take(tag).map(|module| module.channels).sum()
    }

    fn data(&self, value: f64, faults: &Faults) -> String {
        if self.settings.hexadecimal {
            let bits = faults.limited(value, 32_767.0).round() as i16;
            return format!("{:04X}", bits.cast_unsigned());
        }
        engineering(if faults.saturated { f64::INFINITY } else { value })
    }

    /// The answer to a command; syntax errors and other addresses are met by silence.
    fn answer(&mut self, text: &str, now_s: f64, faults: &mut Faults) -> Option<String> {
        if text == "#**" {
            for tag in 0..self.held.len() {
                let field = self.first_field(tag);
                self.held[tag] = if faults.repeats() {
                    (self.held[tag].0, true)
                } else {
                    ((self.signal)(field, now_s), false)
                };
            }
            return None;
        }
        let (lead, address) = (text.get(..1)?, text.get(1..3)?);
        let address = u8::from_str_radix(address, 16).ok()?;
        let modules = &self.settings.modules;
        let tag = modules.iter().position(|module| module.address == address)?;
        let first = self.first_field(tag);
        let n_channels = modules[tag].channels;
        let order = text.get(3..)?;
        if lead == "#" && order.len() <= 1 {
            let newest = self.pace.newest(tag, now_s, faults);
            let n_asked = if order.is_empty() { n_channels } else { 1 };
            let value = |field: usize| self.data((self.signal)(field, newest.host_s), faults);
            let fields: Vec<String> = (first..first + n_asked).map(value).collect();
            return Some(format!(">{}", fields.concat())).filter(|_| !faults.skips());
        }
        Some(match (lead, order) {
            ("$", "M") => format!("!{address:02X}{NAME}"),
            ("$", "2") => {
                let form = if self.settings.hexadecimal { 2 } else { 0 };
                let sum = if self.settings.checksum { 0x40 } else { 0 };
                format!("!{address:02X}0806{:02X}", form + sum)
            }
            ("$", "4") => {
                let (value, was_read) = self.held[tag];
                self.held[tag].1 = true;
                if faults.skips() {
                    return None;
                }
                let fresh = u8::from(!was_read);
                format!(">{address:02X}{fresh}{}", self.data(value, faults))
            }
            ("$" | "%", _) => format!("?{address:02X}"),
            _ => return None,
        })
    }

    fn framed(&self, text: &str) -> Vec<u8> {
        let mut bytes = text.as_bytes().to_vec();
        if self.settings.checksum {
            bytes.extend(dcon_checksum(text.as_bytes()));
        }
        bytes.push(b'\r');
        bytes
    }
}

impl Emulator for DconModules {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        self.heard.extend(bytes);
        while let Some(line) = self.heard.next(|byte| byte == b'\r') {
            let mut text = &line[..];
            if self.settings.checksum {
                let Some((body, sum)) = text.split_last_chunk::<2>() else { continue };
                if *sum != dcon_checksum(body) {
                    continue;
                }
                text = body;
            }
            let text = String::from_utf8_lossy(text).into_owned();
            let answer = self.answer(&text, now_s, faults);
            out.extend(answer.map(|answer| self.framed(&answer)).into_iter().flatten());
        }
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_in_the_manual() {
        let numbers = [1.4567, 9.789, 10.0, -5.8222, 500.0, 0.0].map(engineering);
        let expected = ["+1.4567", "+9.7890", "+10.000", "-5.8222", "+500.00", "+0.0000"];
        assert_eq!(numbers, expected);
        assert_eq!(engineering(f64::INFINITY), "+999999");
    }
}
