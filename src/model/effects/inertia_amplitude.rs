//! Added inertia that changes with the roll angle.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "inertia.amplitude",
    layer: Layer::Inertia,
    equation: "(1 + a phi^2) phi''",
    strengths: &[Parameter::new("a", "1/rad2", 0.5, [-3.0, 3.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Inertia(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Zhao et al. 2016",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[0] * i.roll_rad.powi(2)
}
