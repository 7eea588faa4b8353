//! Lift of the hull: linear damping in proportion to the speed.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, under_way,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.lift",
    layer: Layer::Damping,
    equation: "bL (Fr/0.4) phi'",
    strengths: &[Parameter::new("bL", "1/s", 0.3, [0.0, 3.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: under_way,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Ikeda; ITTC 7.5-02-07-04.5",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.rate_rad_per_s * (i.run.froude / 0.4)
}
