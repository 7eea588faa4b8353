//! Cubic restoring of a hull whose sides are not those of a circle.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "restoring.cubic",
    layer: Layer::Restoring,
    equation: "w^2 k3 phi^3",
    strengths: &[Parameter::new("k3", "1/rad2", 0.7, [-3.0, 3.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "wall-sided formula",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.roll_rad.powi(3) * i.natural_rad_s.powi(2)
}
