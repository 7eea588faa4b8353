//! Added inertia that changes with speed.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, one_node, under_way};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "inertia.speed",
    layer: Layer::Inertia,
    equation: "(1 + c (Fr/0.4)^2) phi''",
    strengths: &[Parameter::new("c", "-", 0.04, [-0.4, 0.4])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: under_way,
    acts: Acts::Inertia(|i, p| p[0] * (i.run.froude / 0.4).powi(2)),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5",
};
