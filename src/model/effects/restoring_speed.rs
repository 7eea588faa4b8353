//! Sinkage, trim and the wave along the hull change the metacentric height with speed.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, under_way,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "restoring.speed",
    layer: Layer::Restoring,
    equation: "w^2 c (Fr/0.4)^2 phi",
    strengths: &[Parameter::new("c", "-", 0.04, [-0.4, 0.4])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: under_way,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.roll_rad * (i.natural_rad_s * (i.run.froude / 0.4)).powi(2)
}
