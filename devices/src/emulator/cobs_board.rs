//! A board that sends COBS frames, as the sketch in `docs/cobs_protocol.md` does.

use super::heard::Heard;
use super::line_pace::{Conversion, LinePace, send_due};
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{CobsSettings, encode_frame, encode_identity, is_who};

const IDENTITY: &str = "rolltank emulated board";

struct CobsBoard {
    n_fields: usize,
    pace: LinePace,
    signal: Signal,
    heard: Heard,
}

pub(super) fn open(parts: Parts<'_>) -> Opened {
    let (CobsSettings { fields: n_fields, .. }, pace, signal) = parts.read()?;
    Ok(Box::new(CobsBoard { n_fields, pace, signal, heard: Heard::default() }))
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
        self.heard.extend(bytes);
        while let Some(frame) = self.heard.next(|byte| byte == 0) {
            if is_who(&frame) {
                out.extend(encode_identity(IDENTITY));
            }
        }
    }

    fn tick(&mut self, now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        let due = self.pace.due(now_s, faults);
        send_due(due, faults, out, |conversion, faults| self.frame(conversion, faults));
    }

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
