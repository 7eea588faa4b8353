//! Samples that a live instrument did not bring, by what its own driver noticed.

use std::collections::BTreeMap;

use devices::InstrumentEvent;

use crate::note::{Note, counted};

/// Counts the gaps of every device of a recording.
#[derive(Debug, Clone, Default)]
pub struct LinkLosses {
    devices: BTreeMap<String, Lost>,
}

#[derive(Debug, Clone, Default)]
struct Lost {
    gaps: u64,
    total_s: f64,
    longest_s: f64,
    longest_from_s: f64,
}

impl LinkLosses {
    /// Takes what a device brought.
    pub fn push(&mut self, device: &str, event: &InstrumentEvent) {
        let InstrumentEvent::Gap { from_s, to_s, .. } = event else { return };
        let lost = self.devices.entry(device.to_owned()).or_default();
        let length_s = to_s - from_s;
        lost.gaps += 1;
        lost.total_s += length_s;
        if length_s > lost.longest_s {
            (lost.longest_s, lost.longest_from_s) = (length_s, *from_s);
        }
    }

    /// Appends a note on each device that lost samples.
    pub fn notes(&self, notes: &mut Vec<Note>) {
        for (device, Lost { gaps, total_s, longest_s, longest_from_s }) in &self.devices {
            notes.push(Note::lost(format!(
                "device \"{device}\": {}, {total_s:.3} s without samples in all, the longest \
                 {longest_s:.3} s after {longest_from_s:.3} s",
                counted(*gaps, "gap")
            )));
        }
    }
}
