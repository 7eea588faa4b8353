//! Quintic damping: the largest swings alone are damped more.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.quintic",
    layer: Layer::Damping,
    equation: "b5 phi'^5",
    strengths: &[Parameter::new("b5", "s3", 0.05, [0.0, 0.5])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Igbadumhe et al. 2020",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.rate_rad_per_s.powi(5)
}
