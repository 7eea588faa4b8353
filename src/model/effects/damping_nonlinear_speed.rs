//! The nonlinear part of the damping changes with speed.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, one_node, under_way};

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
    acts: Acts::Moment(|i, p| -p[0] * (i.run.froude / 0.4).powi(2) * i.rate_rad_per_s.powi(3)),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5: eddies are washed away",
};
