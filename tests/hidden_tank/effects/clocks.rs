//! When samples are taken, and which are lost.

use crate::hidden_tank::effect::{Hidden, Row};
use crate::hidden_tank::instruments::Rows;
use crate::hidden_tank::plan::Pass;
use crate::hidden_tank::timeline::Timeline;

/// The force is sampled earlier or later than the roll; 0.1 to 10 ms, middle 1.
pub(super) const SKEW: Row = Row {
    id: "instrument.channel_skew",
    symbols: &["roll late by [s]"],
    draw: |size, draw, _| vec![size * 0.001 * draw.sign()],
    // A force sampled after its stamp is early in the record, as is a roll that is late.
    hide: |values| Box::new(ForceClock { ahead_s: values[0], rate: 0.0 }),
};

/// The clock of the force runs fast or slow from the start of each recording; 10 to 200 ppm,
/// middle 45.
pub(super) const DRIFT: Row = Row {
    id: "instrument.clock_drift",
    symbols: &["rate [-]"],
    draw: |size, draw, _| vec![size * 45.0e-6 * draw.sign()],
    hide: |values| Box::new(ForceClock { ahead_s: 0.0, rate: values[0] }),
};

struct ForceClock {
    ahead_s: f64,
    rate: f64,
}

impl Hidden for ForceClock {
    fn force_sampled_s(&self, stamp_s: f64, _pass: &Pass) -> f64 {
        stamp_s + self.ahead_s + self.rate * stamp_s
    }
}

/// Scans that went missing without a mark, once in every run; 1 to 5, middle 2.2.
pub(super) const DROPPED: Row = Row {
    id: "instrument.dropped_samples",
    symbols: &["scans [-]"],
    draw: |size, _, _| vec![(size * 2.2).round()],
    hide: |values| Box::new(Dropped(values[0] as usize)),
};

struct Dropped(usize);

impl Hidden for Dropped {
    fn spoil(&self, rows: &mut Rows, pass: &Pass) {
        let begins_s = rows.time_s[0];
        let lost_s = Timeline::of(pass).start_s + 1.0 + 7.0 * pass.chance[1];
        let first = rows.time_s.partition_point(|time_s| *time_s < lost_s);
        for values in rows.channels() {
            values.drain(first..first + self.0);
        }
        // The stamps are counted, not taken: they run on as if nothing had happened.
        rows.time_s.truncate(rows.roll_deg.len());
        debug_assert!(rows.time_s[0] >= begins_s);
    }
}
