//! Mantracourt digitisers on one line, answering MANTRABUS-II: DSC user manual pp. 53-54.

use super::line_pace::LinePace;
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{MantrabusSettings, checksum, to_nibbles};

const START: u8 = 0xFE;
/// `FE`, station, command, two nibbles of check sum.
const READ_BYTES: usize = 5;

struct MantrabusCells {
    settings: MantrabusSettings,
    pace: LinePace,
    signal: Signal,
    heard: Vec<u8>,
}

pub(super) fn open(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read()?;
    Ok(Box::new(MantrabusCells { settings, pace, signal, heard: Vec::new() }))
}

impl MantrabusCells {
    /// The answer to a read; a wrong check sum or another's address is met by silence.
    fn answer(&mut self, frame: &[u8], now_s: f64, faults: &Faults) -> Option<Vec<u8>> {
        let (body, sum) = (&frame[1..3], &frame[3..]);
        let tag = self.settings.stations.iter().position(|station| *station == body[0])?;
        if *sum != checksum(body) {
            return None;
        }
        if body[1] != self.settings.command | 0x80 {
            return Some(vec![body[0], 0x15]);
        }
        let newest = self.pace.newest(now_s, faults);
        let raw = faults.limited((self.signal)(tag, newest.host_s), 1e6);
        let mut reply = vec![body[0]];
        reply.extend(to_nibbles(raw as f32, false));
        reply.extend(checksum(&reply));
        Some(reply)
    }
}

impl Emulator for MantrabusCells {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        for byte in bytes {
            // The host alone sends FE, so it begins a frame wherever it stands.
            if *byte == START {
                self.heard.clear();
            }
            self.heard.push(*byte);
            if self.heard.len() == READ_BYTES && self.heard[0] == START {
                let frame = std::mem::take(&mut self.heard);
                let answer = self.answer(&frame, now_s, faults);
                if faults.n_skips > 0 {
                    faults.n_skips -= 1;
                } else {
                    out.extend(answer.into_iter().flatten());
                }
            }
            self.heard.truncate(READ_BYTES);
        }
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
