//! Was the rod kept going for long enough once the roll was steady?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::run::RunKind;

const GATE: Gate =
    Gate { id: "steady-periods", asks: "Periods of steady forced roll", unit: "–", source: ITTC };

/// Periods wanted.
const N_PERIODS: f64 = 30.0;

pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    if run.run.kind != RunKind::Forced {
        return None;
    }
    let Some(frequency_rad_s) = run.run.excitation_rad_s else {
        return Some(Answer::untold(GATE, "the excitation does not repeat"));
    };
    let duration_s = run.run.end_s - run.run.start_s;
    let n = duration_s * frequency_rad_s / std::f64::consts::TAU;
    Some(Answer::at_least(GATE, n, N_PERIODS, format!("{n:.1} periods in {duration_s:.1} s")))
}
