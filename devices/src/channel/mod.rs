//! What an instrument's readings mean: calibration, range, lag, and the count of what went wrong.

mod calibration;
mod counts;
mod lag;
mod tally;

use serde::{Deserialize, Serialize};

pub use calibration::{Calibration, CalibrationError, Curve, zero_from_readings};
pub use counts::{Brought, Counted, Counts};
pub use lag::{Lag, LagKind};
pub use tally::Tally;

use crate::{Quality, Quantity};

/// One channel: a field of an instrument, and the quantity that it measures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// What it measures.
    pub quantity: Quantity,
    /// Number of the driver's field that carries it.
    pub field: usize,
    /// From the instrument's unit to the quantity's SI unit.
    #[serde(default)]
    pub calibration: Calibration,
    /// What the transducer can measure, in the quantity's SI unit; beyond it a value is flagged.
    #[serde(default)]
    pub range: Option<[f64; 2]>,
}

impl Channel {
    /// The value in SI and its flags.
    pub fn value(&self, raw: f64, quality: Quality) -> (f64, Quality) {
        let value = self.calibration.value(raw);
        let beyond = self.range.is_some_and(|[low, high]| !(low..=high).contains(&value));
        (value, quality.with_if(beyond, Quality::OVER_RANGE))
    }
}
