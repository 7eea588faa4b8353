//! Was the decay followed down to half a degree?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::run::RunKind;

const GATE: Gate =
    Gate { id: "down-to-half-a-degree", asks: "Decay followed down to", unit: "deg", source: ITTC };

/// Roll at which a recording may be stopped [deg].
const SMALLEST_DEG: f64 = 0.5;

pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    if run.run.kind != RunKind::Decay {
        return None;
    }
    Some(match run.identification.half_cycles.last() {
        None => Answer::untold(GATE, "no half cycle was resolved"),
        Some(last) => {
            let amplitude_deg = last.amplitude_rad.to_degrees();
            let words = format!("followed to {amplitude_deg:.2} deg, {}", run.run.end.clause());
            Answer::at_most(GATE, amplitude_deg, SMALLEST_DEG, words)
        }
    })
}
