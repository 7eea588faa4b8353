//! The roll is sampled or stamped later than the moment.

use crate::model::effect::{Acts, Effect, Instant, Layer, Parameter, Scope, forced, one_node};

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
    acts: Acts::Roll(|all, p| all.iter().map(|i| late(i, p[0])).collect()),
    always_equivalent: &[],
    reference: "multiplexed converters",
};

fn late(i: &Instant<'_>, tau_s: f64) -> f64 {
    -tau_s * i.rate_rad_per_s + 0.5 * tau_s * tau_s * i.acceleration_rad_per_s2
}
