//! Was the run sampled densely enough?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::run::RunKind;

const GATE: Gate = Gate {
    id: "sampling",
    asks: "Samples a second of the slowest channel",
    unit: "Hz",
    source: ITTC,
};

/// Lowest rate for a decay [Hz].
const DECAY_HZ: f64 = 50.0;
/// Lowest rate for a forced run, whose phases are wanted [Hz].
const FORCED_HZ: f64 = 200.0;

#[expect(clippy::unnecessary_wraps, reason = "every gate has the same shape")]
pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    let (limit_hz, drive_hz) = match run.run.kind {
        RunKind::Decay => (DECAY_HZ, None),
        RunKind::Forced => (FORCED_HZ, run.sampling.drive_hz),
    };
    let Some(roll_hz) = run.sampling.roll_hz else {
        return Some(Answer::untold(GATE, "the samples of the run are not kept"));
    };
    let words = match drive_hz {
        None => format!("roll at {roll_hz:.1} Hz"),
        Some(drive_hz) => format!("roll at {roll_hz:.1} Hz, rod at {drive_hz:.1} Hz"),
    };
    Some(Answer::at_least(GATE, roll_hz.min(drive_hz.unwrap_or(roll_hz)), limit_hz, words))
}
