//! Are there enough small cycles for the natural period?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::run::RunKind;

const GATE: Gate = Gate {
    id: "small-cycles",
    asks: "Cycles below 5 deg, for the natural period",
    unit: "–",
    source: ITTC,
};

/// Amplitude below which a cycle counts [deg].
const SMALL_DEG: f64 = 5.0;
/// Cycles wanted.
const N_CYCLES: f64 = 8.0;

pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    if run.run.kind != RunKind::Decay {
        return None;
    }
    let halves = run.identification.half_cycles.iter();
    let n = halves.filter(|half| half.amplitude_rad.to_degrees() < SMALL_DEG).count() as f64 / 2.0;
    Some(Answer::at_least(GATE, n, N_CYCLES, format!("{n:.1} cycles below {SMALL_DEG:.0} deg")))
}
