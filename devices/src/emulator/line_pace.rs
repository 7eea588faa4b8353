//! Which conversions an instrument's own clock has made by now.

use std::collections::BTreeMap;

use super::Faults;

/// Conversions at a fixed rate by a clock that may be off.
pub(super) struct LinePace {
    rate_hz: f64,
    start_s: Option<f64>,
    n_made: u64,
    /// The conversion that each station gave last.
    given: BTreeMap<usize, u64>,
}

/// One conversion.
pub(super) struct Conversion {
    pub(super) index: u64,
    /// By the instrument's clock since its start [s].
    pub(super) device_s: f64,
    /// By the host's clock [s].
    pub(super) host_s: f64,
}

/// Conversions handed out at once at most; more is the next tick's.
const AT_ONCE: u64 = 2000;

impl LinePace {
    pub(super) fn new(rate_hz: f64) -> Self {
        Self { rate_hz, start_s: None, n_made: 0, given: BTreeMap::new() }
    }

    pub(super) fn restart(&mut self, now_s: f64) {
        self.start_s = Some(now_s);
        self.n_made = 0;
        self.given.clear();
    }

    /// Host seconds that one conversion takes: a fast clock converts more often.
    fn period_s(&self, faults: &Faults) -> f64 {
        1.0 / (self.rate_hz * (1.0 + faults.drift_ppm * 1e-6))
    }

    /// The conversion that a station gives when it is asked: its newest, or where that is
    /// commanded the one that it gave before.
    pub(super) fn newest(&mut self, tag: usize, now_s: f64, faults: &mut Faults) -> Conversion {
        let start_s = *self.start_s.get_or_insert(now_s);
        let newest = ((now_s - start_s) / self.period_s(faults)).max(0.0) as u64;
        let given = self.given.get(&tag).copied();
        let index = given.filter(|_| faults.repeats()).unwrap_or(newest);
        self.given.insert(tag, index);
        self.conversion(index, start_s, faults)
    }

    /// Whether a station has given its newest conversion already.
    pub(super) fn is_given(&self, tag: usize, now_s: f64, faults: &Faults) -> bool {
        let start_s = self.start_s.unwrap_or(now_s);
        let newest = ((now_s - start_s) / self.period_s(faults)).max(0.0) as u64;
        self.given.get(&tag) == Some(&newest)
    }

    /// The conversions since the last call, for instruments that send unasked.
    pub(super) fn due(&mut self, now_s: f64, faults: &Faults) -> Vec<Conversion> {
        let start_s = *self.start_s.get_or_insert(now_s);
        // The first conversion is made at the start.
        let n_due = ((now_s - start_s) / self.period_s(faults)).max(0.0) as u64 + 1;
        let last = n_due.min(self.n_made + AT_ONCE);
        let due = (self.n_made..last).map(|index| self.conversion(index, start_s, faults));
        let due = due.collect();
        self.n_made = last.max(self.n_made);
        due
    }

    fn conversion(&self, index: u64, start_s: f64, faults: &Faults) -> Conversion {
        Conversion {
            index,
            device_s: index as f64 / self.rate_hz,
            host_s: start_s + index as f64 * self.period_s(faults),
        }
    }
}

/// Sends each due conversion by `write`, or skips or repeats it where that is commanded.
pub(super) fn send_due(
    due: Vec<Conversion>,
    faults: &mut Faults,
    out: &mut Vec<u8>,
    write: impl Fn(&Conversion, &Faults) -> Vec<u8>,
) {
    for conversion in due {
        if faults.skips() {
            continue;
        }
        let bytes = write(&conversion, faults);
        out.extend_from_slice(&bytes);
        if faults.repeats() {
            out.extend_from_slice(&bytes);
        }
    }
}
