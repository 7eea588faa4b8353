//! HBM/HBK digitisers, alone or on a bus, in text or binary: AD104 operating manual.

use super::heard::Heard;
use super::line_pace::{Conversion, LinePace, send_due};
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{HbmAsciiSettings, HbmBinarySettings, HbmFormat};

const LIMIT: f64 = 8_388_608.0;
/// Everyone on the bus listens, nobody answers.
const EVERYONE: u8 = 98;

struct HbmDigitisers {
    /// Addresses; one digitiser without address when empty.
    stations: Vec<u8>,
    /// The binary output format; text when none.
    format: Option<HbmFormat>,
    pace: LinePace,
    signal: Signal,
    heard: Heard,
    selected: Option<u8>,
    streaming: bool,
    /// What each holds since `S98;MSV?;`.
    held: Vec<Option<f64>>,
    /// What each gave of it last.
    given: Vec<f64>,
}

pub(super) fn open_ascii(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read::<HbmAsciiSettings>()?;
    Ok(Box::new(HbmDigitisers::new(settings.stations, None, pace, signal)))
}

pub(super) fn open_binary(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read::<HbmBinarySettings>()?;
    let format = HbmFormat::new(settings.format, settings.checked)?;
    Ok(Box::new(HbmDigitisers::new(Vec::new(), Some(format), pace, signal)))
}

impl HbmDigitisers {
    fn new(stations: Vec<u8>, format: Option<HbmFormat>, pace: LinePace, signal: Signal) -> Self {
        Self {
            held: vec![None; stations.len().max(1)],
            given: vec![0.0; stations.len().max(1)],
            stations,
            format,
            pace,
            signal,
            heard: Heard::default(),
            selected: None,
            streaming: false,
        }
    }

    fn measured(&self, tag: usize, host_s: f64, faults: &Faults) -> f64 {
        if faults.saturated { -LIMIT } else { (self.signal)(tag, host_s).round() }
    }

    fn written(&self, raw: f64) -> Vec<u8> {
        let raw = raw.clamp(-LIMIT, LIMIT - 1.0) as i32;
        match self.format {
            Some(format) => format.write(raw),
            None => format!("{raw:+08}\r\n").into_bytes(),
        }
    }

    /// What one command without its semicolon brings.
    fn obey(&mut self, command: &str, now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        let select = command.strip_prefix('S').and_then(|station| station.parse::<u8>().ok());
        if let Some(station) = select {
            self.selected = Some(station);
            let Some(tag) = self.stations.iter().position(|known| *known == station) else {
                return;
            };
            let Some(held) = self.held[tag].take() else { return };
            if !faults.repeats() {
                self.given[tag] = held;
            }
            if !faults.skips() {
                out.extend(self.written(self.given[tag]));
            }
            return;
        }
        let everyone = self.selected == Some(EVERYONE);
        let tag = match self.selected {
            Some(station) if !self.stations.is_empty() => {
                self.stations.iter().position(|known| *known == station)
            }
            _ => self.stations.is_empty().then_some(0),
        };
        if everyone && command == "MSV?" {
            for tag in 0..self.held.len() {
                self.held[tag] = Some(self.measured(tag, now_s, faults));
            }
            return;
        }
        let Some(tag) = tag else { return };
        match command {
            "STP" => self.streaming = false,
            "MSV?0" => {
                self.streaming = true;
                self.pace.restart(now_s);
            }
            "MSV?" => {
                let newest = self.pace.newest(tag, now_s, faults);
                if !faults.skips() {
                    out.extend(self.written(self.measured(tag, newest.host_s, faults)));
                }
            }
            "IDN?" => out.extend(b"HBM,AD104C,170123,P54\r\n"),
            _ if ["ASF", "COF", "ICR", "CSM", "NOV", "SPW"].contains(&&command[..3]) => {
                out.extend(b"0\r\n");
            }
            _ => out.extend(b"?\r\n"),
        }
    }
}

impl Emulator for HbmDigitisers {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        self.heard.extend(bytes);
        while let Some(command) = self.heard.next(|byte| matches!(byte, b';' | b'\n')) {
            let command = String::from_utf8_lossy(&command).trim().to_ascii_uppercase();
            // A lone terminator clears the input, and what is no command at all is refused.
            match command.get(..3) {
                Some(_) if command.is_ascii() => self.obey(&command, now_s, faults, out),
                _ if command.is_empty() => {}
                _ => out.extend(b"?\r\n"),
            }
        }
    }

    fn tick(&mut self, now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        if self.streaming {
            let due = self.pace.due(now_s, faults);
            send_due(due, faults, out, |conversion: &Conversion, faults| {
                self.written(self.measured(0, conversion.host_s, faults))
            });
        }
    }

    fn restart(&mut self, now_s: f64) {
        self.streaming = false;
        self.selected = None;
        self.pace.restart(now_s);
    }
}
