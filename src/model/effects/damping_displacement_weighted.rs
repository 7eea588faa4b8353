//! Damping that grows with the roll angle itself, as van der Pol's does.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, any_run, one_node};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.displacement_weighted",
    layer: Layer::Damping,
    equation: "bf phi^2 phi'",
    strengths: &[Parameter::new("bf", "1/s", 15.0, [0.0, 150.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(|i, p| -p[0] * i.roll_rad.powi(2) * i.rate_rad_per_s),
    always_equivalent: &[],
    reference: "van der Pol 1926",
};
