//! The zero of the roll channel drifts.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, any_run, one_node};

/// The effect.
pub const EFFECT: Effect = Effect {
    id: "instrument.roll_drift",
    layer: Layer::Instrument,
    equation: "phi + d t/20 s",
    strengths: &[Parameter::new("d", "rad", 0.002, [-0.02, 0.02])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(|all, p| all.iter().map(|i| p[0] * i.time_s / 20.0).collect()),
    always_equivalent: &[],
    reference: "sensor data sheets",
};
