//! Was the model at rest before it was heeled and released?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, OUR_LIMIT};
use crate::run::RunKind;

const GATE: Gate = Gate {
    id: "rest-before-release",
    asks: "Recorded at rest before the release, for one roll period",
    unit: "s",
    source: OUR_LIMIT,
};

pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    if run.run.kind != RunKind::Decay {
        return None;
    }
    let limit_s = std::f64::consts::TAU / run.identification.natural_frequency_rad_s.mean;
    Some(match run.run.still {
        None => Answer::missing(GATE, limit_s, "no rest at the mean of the roll was recorded"),
        Some(still) => {
            let rest_s = still.end_s - still.start_s;
            let before_s = run.run.start_s - still.end_s;
            let words = format!("at rest for {rest_s:.1} s until {before_s:.1} s before");
            Answer::at_least(GATE, rest_s, limit_s, words)
        }
    })
}
