//! The roll channel leaks into the moment channel.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, with_moment,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.moment_from_roll",
    layer: Layer::Instrument,
    equation: "M + c phi",
    strengths: &[Parameter::new("c", "N m/rad", 0.5, [-5.0, 5.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: with_moment,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "crosstalk of bridge and potentiometer",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[0] * i.roll_rad
}
