//! The nonlinear part of the damping changes with speed.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, under_way,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.nonlinear_speed",
    layer: Layer::Damping,
    equation: "c3 (Fr/0.4)^2 phi'^3",
    strengths: &[Parameter::new("c3", "s", 0.3, [-3.0, 3.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: under_way,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5: eddies are washed away",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.rate_rad_per_s.powi(3) * f64::powi(i.run.froude / 0.4, 2)
}
