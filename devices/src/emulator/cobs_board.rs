//! A board that sends COBS frames, as the sketch in `docs/cobs_protocol.md` does.

use super::line_pace::{Conversion, LinePace, send_due};
use super::{Emulator, Faults, Signal};
use crate::driver::{CobsSettings, SettingsError, encode_frame, encode_identity, is_who, settings};

const IDENTITY: &str = "rolltank emulated board";

struct CobsBoard {
    n_fields: usize,
    pace: LinePace,
    signal: Signal,
    heard: Vec<u8>,
}

pub(super) fn open(
    table: &toml::Table,
    rate_hz: f64,
    signal: Signal,
) -> Result<Box<dyn Emulator>, SettingsError> {
    let settings: CobsSettings = settings(table)?;
    let n_fields = settings.fields;
    Ok(Box::new(CobsBoard { n_fields, pace: LinePace::new(rate_hz), signal, heard: Vec::new() }))
}

impl CobsBoard {
    fn frame(&self, conversion: &Conversion, faults: &Faults) -> Vec<u8> {
        let value = |field| {
            let raw = (self.signal)(field, conversion.host_s);
            faults.limited(raw, 8_388_607.0).round() as i32
        };
        let values: Vec<i32> = (0..self.n_fields).map(value).collect();
        let time_us = (conversion.device_s * 1e6).round() as u64;
        encode_frame(conversion.index as u32, time_us, &values)
    }
}

impl Emulator for CobsBoard {
    fn receive(&mut self, bytes: &[u8], _now_s: f64, _faults: &mut Faults, out: &mut Vec<u8>) {
        self.heard.extend_from_slice(bytes);
        while let Some(end) = self.heard.iter().position(|byte| *byte == 0) {
            let frame: Vec<u8> = self.heard.drain(..=end).collect();
            if is_who(&frame[..end]) {
                out.extend(encode_identity(IDENTITY));
            }
        }
        let excess = self.heard.len().saturating_sub(256);
        self.heard.drain(..excess);
    }

    fn tick(&mut self, now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        let due = self.pace.due(now_s, faults);
        send_due(due, faults, out, |conversion, faults| self.frame(conversion, faults));
    }

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
