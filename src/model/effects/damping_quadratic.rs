//! Quadratic damping: eddies and bilge keels drag with the square of the rate.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.quadratic",
    layer: Layer::Damping,
    equation: "b2 phi'|phi'|",
    strengths: &[Parameter::new("b2", "1/rad", 0.4, [0.0, 2.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.rate_rad_per_s * i.rate_rad_per_s.abs()
}
