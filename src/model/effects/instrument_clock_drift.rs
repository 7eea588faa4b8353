//! The clocks of roll and moment run at different rates.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, forced, one_node};

/// The effect.
pub const EFFECT: Effect = Effect {
    id: "instrument.clock_drift",
    layer: Layer::Instrument,
    equation: "phi(t (1 - c))",
    strengths: &[Parameter::new("c", "-", 0.0001, [-0.002, 0.002])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Roll(|all, p| all.iter().map(|i| -p[0] * i.time_s * i.rate_rad_per_s).collect()),
    always_equivalent: &[],
    reference: "crystal data sheets",
};
