//! The last seconds of the links, with which the next recording begins.

use replay::{PreTrigger, Raw, Record};

/// While it is recorded, so much is remembered [s]: the next recording repeats it to know the
/// clocks of the instruments from its first sample on, whose bounds take eight seconds.
const RECORDED_S: f64 = 10.0;
/// Of what is not recorded, so much is remembered [s] and begins the next recording: whoever lets
/// the model go and then sees that nothing is recorded has the run.
const UNRECORDED_S: f64 = 30.0;
/// Memory that it may take [bytes]: four times what four channels at 2 kHz need.
const BYTES_MAX: usize = 32 << 20;

/// What happened on the links lately, oldest first; the newest of it may be in no recording.
pub(super) struct Remembered {
    ring: PreTrigger,
    /// So many of the newest are in no recording.
    n_unrecorded: usize,
}

impl Remembered {
    /// Nothing yet.
    pub(super) fn new() -> Self {
        Self { ring: PreTrigger::new(RECORDED_S, BYTES_MAX), n_unrecorded: 0 }
    }

    /// Remembers what happened and forgets what has become too old.
    pub(super) fn push(&mut self, raw: Raw, is_recorded: bool) {
        if is_recorded {
            self.n_unrecorded = 0;
        } else {
            self.n_unrecorded += 1;
            self.ring.span(UNRECORDED_S);
        }
        self.ring.push(Record::Raw(raw));
        self.n_unrecorded = self.n_unrecorded.min(self.ring.len());
    }

    /// Time of the oldest of it [s].
    pub(super) fn begins_s(&self) -> Option<f64> {
        self.ring.begins_s()
    }

    /// Gives what is in the recording before and then what is in none, and begins anew.
    pub(super) fn pour(&mut self) -> [Vec<Raw>; 2] {
        let n_recorded = self.ring.len() - self.n_unrecorded;
        let all = self.ring.pour().filter_map(|record| match record {
            Record::Raw(raw) => Some(raw),
            _ => None,
        });
        let mut recorded: Vec<Raw> = all.collect();
        let unrecorded = recorded.split_off(n_recorded);
        *self = Self::new();
        [recorded, unrecorded]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use replay::Direction;

    fn raw(time_s: f64) -> Raw {
        Raw { device: "board".into(), time_s, direction: Direction::Received, bytes: vec![1] }
    }

    #[test]
    fn what_no_recording_holds_is_remembered_longer_and_told_apart() {
        let mut remembered = Remembered::new();
        (0..20).for_each(|second| remembered.push(raw(f64::from(second)), true));
        assert_eq!(remembered.begins_s(), Some(9.0));
        (20..25).for_each(|second| remembered.push(raw(f64::from(second)), false));
        let [recorded, unrecorded] = remembered.pour();
        let first_s = |raws: &[Raw]| raws.first().map(|raw| raw.time_s);
        assert_eq!((first_s(&recorded), recorded.len()), (Some(9.0), 11));
        assert_eq!((first_s(&unrecorded), unrecorded.len()), (Some(20.0), 5));
        // Of an hour without a recording there is only the end, and all of it is new.
        (0..3600).for_each(|second| remembered.push(raw(f64::from(second)), false));
        let [recorded, unrecorded] = remembered.pour();
        assert!(recorded.is_empty());
        assert_eq!((first_s(&unrecorded), unrecorded.len()), (Some(3569.0), 31));
        assert_eq!(remembered.begins_s(), None);
    }
}
