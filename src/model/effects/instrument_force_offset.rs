//! The load cell does not read nil without a force, or carries the rod.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, with_moment,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.force_offset",
    layer: Layer::Instrument,
    equation: "M + m0",
    strengths: &[Parameter::new("m0", "N m", 0.2, [-5.0, 5.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: with_moment,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "calibration; weight of the rod",
};

fn law<N: Number>(_: &Instant<'_, N>, p: &[N]) -> N {
    p[0]
}
