//! The zero of the load cell creeps.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, one_node, with_moment};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.force_drift",
    layer: Layer::Instrument,
    equation: "M + m0 + d t/20 s",
    strengths: &[
        Parameter::new("d", "N m", 0.1, [-2.0, 2.0]),
        Parameter::new("m0", "N m", 0.2, [-5.0, 5.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: with_moment,
    acts: Acts::Drive(|i, p| p[1] + p[0] * i.time_s / 20.0),
    always_equivalent: &[],
    reference: "HBM; OIML R60",
};
