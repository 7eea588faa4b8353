//! Lift of the hull: linear damping in proportion to the speed.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, one_node, under_way};

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
    acts: Acts::Moment(|i, p| -p[0] * i.run.froude / 0.4 * i.rate_rad_per_s),
    always_equivalent: &[],
    reference: "Ikeda; ITTC 7.5-02-07-04.5",
};
