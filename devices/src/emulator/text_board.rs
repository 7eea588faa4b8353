//! A board that sends lines of text by a pattern, or answers with them.

use super::line_pace::{Conversion, LinePace, send_due};
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{IdentityLine, Pattern, PatternValues, SettingsError, TextLineSettings};

const NAME: &str = "rolltank emulated board";

struct TextBoard {
    settings: TextLineSettings,
    pattern: Pattern,
    identity: Option<IdentityLine>,
    pace: LinePace,
    signal: Signal,
    heard: Vec<u8>,
}

pub(super) fn open(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read::<TextLineSettings>()?;
    let pattern = Pattern::new(&settings.pattern, settings.decimal_comma).map_err(SettingsError)?;
    let identity = settings.identity_line.as_deref().map(IdentityLine::new).transpose()?;
    Ok(Box::new(TextBoard { settings, pattern, identity, pace, signal, heard: Vec::new() }))
}

impl TextBoard {
    fn line(&self, conversion: &Conversion, faults: &Faults) -> Vec<u8> {
        let field = |field| {
            let raw = (self.signal)(field, conversion.host_s);
            (field, faults.limited(raw, 8_388_607.0))
        };
        let turn = |value: u64, bits: u32| {
            if bits < 64 { value % (1 << bits) } else { value }
        };
        let ticks = (conversion.device_s * self.pattern.ticks_per_s().unwrap_or(0.0)).round();
        let mut line = self.pattern.write(&PatternValues {
            fields: (0..self.pattern.n_fields()).map(field).collect(),
            sequence: Some(turn(conversion.index, self.settings.sequence_bits)),
            ticks: Some(turn(ticks as u64, self.settings.time_bits)),
        });
        line.extend_from_slice(self.settings.terminators.as_bytes());
        line
    }
}

impl Emulator for TextBoard {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        self.heard.extend_from_slice(bytes);
        let heard = |order: &Option<String>| {
            order.as_ref().is_some_and(|order| self.heard.ends_with(order.as_bytes()))
        };
        let (is_asked, is_read) = (heard(&self.settings.identify), heard(&self.settings.request));
        if is_asked {
            let said = self.identity.as_ref().map(|identity| identity.write(NAME));
            out.extend(said.unwrap_or_default().into_bytes());
            out.extend_from_slice(self.settings.terminators.as_bytes());
        }
        if is_read {
            let newest = self.pace.newest(0, now_s, faults);
            if !faults.skips() {
                out.extend(self.line(&newest, faults));
            }
        }
        if is_asked || is_read {
            self.heard.clear();
        }
        let excess = self.heard.len().saturating_sub(256);
        self.heard.drain(..excess);
    }

    fn tick(&mut self, now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        if self.settings.request.is_none() {
            let due = self.pace.due(now_s, faults);
            send_due(due, faults, out, |conversion, faults| self.line(conversion, faults));
        }
    }

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
