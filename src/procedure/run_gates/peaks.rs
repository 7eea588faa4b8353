//! Does the decay have enough peaks to part its coefficients?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, OUR_LIMIT};
use crate::run::RunKind;

const GATE: Gate = Gate { id: "peaks", asks: "Peaks of the decay", unit: "–", source: OUR_LIMIT };

/// Two for each of linear damping, nonlinear damping, frequency.
const N_PEAKS: f64 = 6.0;

pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    if run.run.kind != RunKind::Decay {
        return None;
    }
    let n = match run.identification.half_cycles.len() {
        0 => 0,
        n => n + 1,
    };
    Some(Answer::at_least(GATE, n as f64, N_PEAKS, format!("{n} peaks, both sides counted")))
}
