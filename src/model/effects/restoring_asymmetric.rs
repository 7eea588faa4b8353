//! Restoring that differs between port and starboard.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "restoring.asymmetric",
    layer: Layer::Restoring,
    equation: "w^2 k2 phi^2",
    strengths: &[Parameter::new("k2", "1/rad", 0.15, [-1.0, 1.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "hydrostatics",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * i.roll_rad.powi(2) * i.natural_rad_s.powi(2)
}
