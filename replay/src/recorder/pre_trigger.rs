//! Remembers the last seconds before a recording begins, so that it can begin before its trigger.

use std::collections::VecDeque;
use std::mem::size_of;

use crate::record::Record;

/// Devices, calibrations and campaign files remembered; far more than a tank has.
const STANDING_MAX: usize = 1024;

/// A ring of the latest records, bounded in time and in bytes.
///
/// What holds until further notice (devices, calibrations, the campaign file, the clocks) stands
/// outside the ring: it is remembered however old it is, and begins every recording.
#[derive(Debug)]
pub struct PreTrigger {
    span_s: f64,
    bytes_max: usize,
    ring: VecDeque<Record>,
    bytes: usize,
    standing: Vec<Record>,
    crowded_out: u64,
}

impl PreTrigger {
    /// An empty ring that will span a time [s] or take so many bytes, whichever is less.
    pub fn new(span_s: f64, bytes_max: usize) -> Self {
        let (ring, standing) = (VecDeque::new(), Vec::new());
        Self { span_s, bytes_max, ring, bytes: 0, standing, crowded_out: 0 }
    }

    /// Spans another time [s] from now on.
    pub fn span(&mut self, span_s: f64) {
        self.span_s = span_s;
    }

    /// Remembers a record and forgets what has become too old.
    pub fn push(&mut self, record: impl Into<Record>) {
        let record = record.into();
        if let Some(key) = standing_key(&record) {
            self.standing.retain(|stands| standing_key(stands) != Some(key));
            if self.standing.len() == STANDING_MAX {
                self.standing.remove(0);
            }
            self.standing.push(record);
            return;
        }
        let from_s = record.time_s() - self.span_s;
        self.bytes += bytes_of(&record);
        self.ring.push_back(record);
        while let Some(oldest) = self.ring.front() {
            let is_old = oldest.time_s() < from_s;
            if !is_old && self.bytes <= self.bytes_max {
                break;
            }
            self.crowded_out += u64::from(!is_old);
            self.bytes -= bytes_of(oldest);
            self.ring.pop_front();
        }
    }

    /// Gives everything for a recording that was just started, what stands first and then the
    /// oldest, and begins anew.
    pub fn pour(&mut self) -> impl Iterator<Item = Record> {
        self.bytes = 0;
        self.standing.clone().into_iter().chain(self.ring.drain(..))
    }

    /// Time of the oldest record in the ring [s].
    pub fn begins_s(&self) -> Option<f64> {
        Some(self.ring.front()?.time_s())
    }

    /// Records in the ring.
    pub fn len(&self) -> usize {
        self.ring.len()
    }

    /// Whether the ring holds nothing.
    pub fn is_empty(&self) -> bool {
        self.ring.is_empty()
    }

    /// Records that the bound in bytes drove out before their time.
    pub fn crowded_out(&self) -> u64 {
        self.crowded_out
    }
}

/// What a record that holds until further notice is about; the next of its kind takes its place.
fn standing_key(record: &Record) -> Option<(&'static str, &str, &str)> {
    match record {
        Record::Device(device) => Some(("device", &device.device, "")),
        Record::Calibration(taken) => Some(("calibration", &taken.device, &taken.channel)),
        Record::Campaign(_) => Some(("campaign", "", "")),
        Record::Clock(_) => Some(("clock", "", "")),
        _ => None,
    }
}

/// Memory that a record takes, near enough.
fn bytes_of(record: &Record) -> usize {
    let text = match record {
        Record::Raw(raw) => raw.bytes.capacity(),
        Record::Result(result) => result.document.capacity() + result.schema.capacity(),
        Record::Rejection(rejection) => rejection.reason.capacity(),
        Record::RunStop(stop) => stop.reason.capacity() + 128 * stop.counts.capacity(),
        _ => 0,
    };
    size_of::<Record>() + text
}
