//! Quintic restoring: the largest angles alone are held harder.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "restoring.quintic",
    layer: Layer::Restoring,
    equation: "w^2 k5 phi^5",
    strengths: &[Parameter::new("k5", "1/rad4", 3.0, [-20.0, 20.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Ibrahim & Grace 2010",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.roll_rad.powi(5) * i.natural_rad_s.powi(2)
}
