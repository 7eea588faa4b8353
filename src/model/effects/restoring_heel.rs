//! A static heel: the model rests at another angle than upright.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "restoring.heel",
    layer: Layer::Restoring,
    equation: "w^2 (phi - phis)",
    strengths: &[Parameter::new("phis", "rad", 0.004, [-0.05, 0.05])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &["instrument.roll_offset"],
    reference: "hydrostatics",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[0] * i.natural_rad_s.powi(2)
}
