//! Added inertia that changes with speed.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, under_way,
};
use crate::model::number::Number;

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
    acts: Acts::Inertia(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[0] * f64::powi(i.run.froude / 0.4, 2)
}
