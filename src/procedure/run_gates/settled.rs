//! Had the waves of the run before died when this one began?

use super::Asked;
use crate::procedure::gate::{Answer, Gate, OUR_LIMIT};

const GATE: Gate =
    Gate { id: "settled", asks: "Roll left by the run before", unit: "deg", source: OUR_LIMIT };

/// Amplitude of the roll at rest that still counts as calm [deg].
pub const CALM_DEG: f64 = 0.1;

#[expect(clippy::unnecessary_wraps, reason = "every gate has the same shape")]
pub(super) fn answer(Asked { run, .. }: &Asked<'_>) -> Option<Answer> {
    let Some(still) = run.run.still else {
        return Some(Answer::untold(GATE, "no rest was recorded before the run"));
    };
    let noise_rad = run.identification.roll_noise_rad.mean;
    let roll_rad = (still.roll_sd_rad.powi(2) - noise_rad.powi(2)).max(0.0).sqrt();
    // The amplitude of a sine is root two times its standard deviation.
    let amplitude_deg = (std::f64::consts::SQRT_2 * roll_rad).to_degrees();
    let words = format!("rolled by {amplitude_deg:.3} deg at rest, noise apart");
    Some(Answer::at_most(GATE, amplitude_deg, CALM_DEG, words))
}
