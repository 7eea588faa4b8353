//! Mantracourt digitisers on one line, answering ASCII: DSC user manual, appendix B.

use super::heard::Heard;
use super::line_pace::LinePace;
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::MantracourtSettings;

const VERSION: u32 = 3 * 256 + 1;
const STAT_OVER: u32 = 1 << 9;
const STAT_OLD: u32 = 1 << 13;
/// `DPB` 6 and `DP` 3: more does not fit the field.
const LIMIT: f64 = 999_999.999;

struct MantracourtCells {
    settings: MantracourtSettings,
    pace: LinePace,
    signal: Signal,
    heard: Heard,
    /// What each station holds since `SNAP`, and what it gave of it last.
    snapshot: Vec<f64>,
    given: Vec<f64>,
}

pub(super) fn open(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read::<MantracourtSettings>()?;
    let n_stations = settings.stations.len();
    Ok(Box::new(MantracourtCells {
        settings,
        pace,
        signal,
        heard: Heard::default(),
        snapshot: vec![0.0; n_stations],
        given: vec![0.0; n_stations],
    }))
}

impl MantracourtCells {
    fn value(&self, tag: usize, now_s: f64, faults: &Faults) -> f64 {
        faults.limited((self.signal)(tag, now_s), LIMIT)
    }

    /// The answer to one command without its carriage return; none is silence.
    fn answer(&mut self, command: &[u8], now_s: f64, faults: &mut Faults) -> Option<String> {
        let text = str::from_utf8(command).ok()?.strip_prefix('!')?;
        let (station, rest) = text.split_at_checked(3)?;
        let station: u16 = station.parse().ok()?;
        let order = rest.strip_prefix(':')?.to_ascii_uppercase();
        if station == 0 {
            if order == "SNAP" {
                for tag in 0..self.snapshot.len() {
                    self.snapshot[tag] = self.value(tag, now_s, faults);
                }
            }
            return None;
        }
        let tag = self.settings.stations.iter().position(|known| *known == station)?;
        let reading = format!("{}?", self.settings.read.to_ascii_uppercase());
        Some(match order.as_str() {
            "VER?" => number(f64::from(VERSION)),
            "SYSN?" => {
                if !faults.repeats() {
                    self.given[tag] = self.snapshot[tag];
                }
                number(Some(self.given[tag]).filter(|_| !faults.skips())?)
            }
            "STAT?" => {
                // With SNAP a value is new by definition; a repeat is commanded.
                let polled = !self.settings.snapshot && self.pace.is_given(tag, now_s, faults);
                let old = polled || faults.n_repeats > 0;
                let over = if faults.saturated { STAT_OVER } else { 0 };
                number(f64::from(over + if old { STAT_OLD } else { 0 }))
            }
            _ if order == reading => {
                let newest = self.pace.newest(tag, now_s, faults);
                if faults.skips() {
                    return None;
                }
                number(self.value(tag, newest.host_s, faults))
            }
            "SNAP" | "RST" => String::new(),
            written if written.contains('=') => String::new(),
            _ => "?".to_owned(),
        })
    }
}

/// Sign, six digits, point, three digits.
fn number(value: f64) -> String {
    format!("{value:+011.3}")
}

impl Emulator for MantracourtCells {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        self.heard.extend(bytes);
        while let Some(command) = self.heard.next(|byte| byte == b'\r') {
            let answer = self.answer(&command, now_s, faults);
            if let Some(answer) = answer {
                out.extend_from_slice(answer.as_bytes());
                out.push(b'\r');
            }
        }
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
