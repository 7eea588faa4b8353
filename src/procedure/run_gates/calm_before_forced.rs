//! Was the water calm for long enough before the rod began, to check the zeros?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::run::RunKind;

const GATE: Gate = Gate {
    id: "calm-before-forced",
    asks: "Calm water before the rod moves, for the zeros",
    unit: "s",
    source: ITTC,
};

/// Calm water to record first [s].
const CALM_S: f64 = 20.0;

pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    if run.run.kind != RunKind::Forced {
        return None;
    }
    Some(match run.run.still {
        None => Answer::missing(GATE, CALM_S, "no calm was recorded before the rod moved"),
        Some(still) => {
            let calm_s = still.end_s - still.start_s;
            // No more than this much of a rest is kept.
            let or_more = if calm_s >= CALM_S { " or more" } else { "" };
            let before_s = run.run.start_s - still.end_s;
            let words = format!("calm for {calm_s:.1} s{or_more} until {before_s:.1} s before");
            Answer::at_least(GATE, calm_s, CALM_S, words)
        }
    })
}
