//! Mantracourt digitisers on one line, answering MANTRABUS-II: DSC user manual pp. 53-54.

use super::line_pace::LinePace;
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{MantrabusSettings, checksum, to_nibbles};

const START: u8 = 0xFE;
/// `FE`, station, command, two nibbles of check sum.
const READ_BYTES: usize = 5;
/// The same with the eight nibbles of a number.
const WRITE_BYTES: usize = 13;
const READ: u8 = 0x80;
const ACCEPTED: u8 = 0x06;
const REFUSED: u8 = 0x15;
const VERSION: f32 = 3.0 * 256.0 + 1.0;

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
    /// The answer to a command; a wrong check sum or another's address is met by silence.
    fn answer(&mut self, frame: &[u8], now_s: f64, faults: &mut Faults) -> Option<Vec<u8>> {
        let (body, sum) = frame[1..].split_at(frame.len() - 3);
        let tag = self.settings.stations.iter().position(|station| *station == body[0])?;
        if *sum != checksum(body) {
            return None;
        }
        if body[1] & READ == 0 {
            return Some(vec![body[0], ACCEPTED]);
        }
        let command = body[1] & !READ;
        let number = if command == self.settings.command {
            let newest = self.pace.newest(tag, now_s, faults);
            if faults.skips() {
                return None;
            }
            faults.limited((self.signal)(tag, newest.host_s), 1e6) as f32
        } else if Some(command) == self.settings.version_command {
            VERSION
        } else {
            return Some(vec![body[0], REFUSED]);
        };
        let mut reply = vec![body[0]];
        reply.extend(to_nibbles(number, false));
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
            let is_read = self.heard.get(2).is_some_and(|command| command & READ != 0);
            let n_bytes = if is_read { READ_BYTES } else { WRITE_BYTES };
            if self.heard.len() == n_bytes && self.heard[0] == START {
                let frame = std::mem::take(&mut self.heard);
                out.extend(self.answer(&frame, now_s, faults).into_iter().flatten());
            }
            self.heard.truncate(WRITE_BYTES);
        }
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
