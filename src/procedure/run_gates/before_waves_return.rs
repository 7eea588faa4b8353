//! Was the stretch used over before the model's own waves were back from the side walls?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, ITTC};
use crate::roll::wall_waves;
use crate::run::RunKind;

const GATE: Gate = Gate {
    id: "before-waves-return",
    asks: "Used from the first motion on, before waves are back from the side walls",
    unit: "s",
    source: ITTC,
};

#[expect(clippy::unnecessary_wraps, reason = "every gate has the same shape")]
pub(super) fn answer(Asked { campaign, run }: &Asked<'_>) -> Option<Answer> {
    let found = &run.run;
    let natural_rad_s = run.identification.natural_frequency_rad_s.mean;
    let frequency_rad_s = found.excitation_rad_s.unwrap_or(natural_rad_s);
    if !frequency_rad_s.is_finite() {
        return Some(Answer::untold(GATE, "the frequency of the roll is not known"));
    }
    let gravity_m_s2 = campaign.water.gravity_m_s2;
    let Some(width_m) = campaign.tank.width_m else {
        return Some(Answer::untold(GATE, "width_m is not given in [tank] of campaign.toml"));
    };
    let clear_m = width_m - campaign.hull.beam_m;
    let trip_s = wall_waves::trip_s(clear_m, frequency_rad_s, gravity_m_s2);
    // A steady stretch is cut from a motion that began with the end of the rest before it.
    let began_s = match (found.kind, found.still) {
        (RunKind::Forced, Some(still)) => still.end_s,
        _ => found.start_s,
    };
    let used_s = found.end_s - began_s;
    if wall_waves::outrun(frequency_rad_s, run.speed_m_s.abs(), gravity_m_s2) >= 1.0 {
        let words = format!("at {:.2} m/s the model outruns its waves", run.speed_m_s.abs());
        return Some(Answer { met: Some(true), ..Answer::at_most(GATE, used_s, trip_s, words) });
    }
    let words = format!("used for {used_s:.1} s; the first waves are back after {trip_s:.1} s");
    Some(Answer::at_most(GATE, used_s, trip_s, words))
}
