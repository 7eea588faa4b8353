//! The clocks of roll and moment run at different rates.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, forced, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.clock_drift",
    layer: Layer::Instrument,
    equation: "phi(t - c t - tau)",
    strengths: &[
        Parameter::new("c", "-", 0.0001, [-0.002, 0.002]),
        Parameter::new("tau", "s", 0.004, [-0.05, 0.05]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &[],
    reference: "crystal data sheets",
};

fn late<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let late_s = p[0] * i.time_s + p[1];
    -late_s * i.rate_rad_per_s + late_s * late_s * i.acceleration_rad_per_s2 * 0.5
}

fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    all.iter().map(|i| late(i, p)).collect()
}
