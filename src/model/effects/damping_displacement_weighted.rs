//! Damping that grows with the roll angle itself, as van der Pol's does.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.displacement_weighted",
    layer: Layer::Damping,
    equation: "bf phi^2 phi'",
    strengths: &[Parameter::new("bf", "1/s", 15.0, [0.0, 400.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "van der Pol 1926",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.roll_rad.powi(2) * i.rate_rad_per_s
}
