//! A low-pass filter makes the roll channel lag.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_lag",
    layer: Layer::Instrument,
    equation: "tau z' = phi - z",
    strengths: &[Parameter::new("tau", "s", 0.015, [0.0, 0.09])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(Reading { plain: lag, sloped: lag }),
    always_equivalent: &[],
    reference: "filter theory",
};

/// First-order lag of a course that is straight between samples.
fn lag<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let tau_s = p[0];
    let Some(first) = all.first() else { return Vec::new() };
    // The filter has long run: the series of what it lacks, the fourth derivative left out.
    let third = first.rate_rad_per_s * -first.run.rolling_rad_s.powi(2);
    let mut behind = tau_s * (tau_s * (first.acceleration_rad_per_s2 - tau_s * third))
        - tau_s * first.rate_rad_per_s;
    let mut lost = vec![behind];
    for pair in all.windows(2) {
        let step_s = pair[1].time_s - pair[0].time_s;
        let slope = (pair[1].roll_rad - pair[0].roll_rad) / step_s;
        let fades =
            if tau_s.value() > 0.0 { (N::from(-step_s) / tau_s).exp() } else { N::from(0.0) };
        behind = -tau_s * slope + (behind + tau_s * slope) * fades;
        lost.push(behind);
    }
    lost
}
