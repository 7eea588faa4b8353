//! The roll is sampled or stamped later than the moment.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, forced, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.channel_skew",
    layer: Layer::Instrument,
    equation: "phi(t - tau)",
    strengths: &[Parameter::new("tau", "s", 0.004, [-0.03, 0.03])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &[],
    reference: "multiplexed converters",
};

fn late<N: Number>(i: &Instant<'_, N>, tau_s: N) -> N {
    -tau_s * i.rate_rad_per_s + tau_s * tau_s * i.acceleration_rad_per_s2 * 0.5
}

fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    all.iter().map(|i| late(i, p[0])).collect()
}
