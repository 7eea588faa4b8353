//! The moment channel leaks into the roll channel.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, forced, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_from_moment",
    layer: Layer::Instrument,
    equation: "phi + c M",
    strengths: &[Parameter::new("c", "rad/(N m)", 0.0003, [-0.003, 0.003])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &[],
    reference: "crosstalk of bridge and potentiometer",
};

fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    all.iter().map(|i| p[0] * i.moment_n_m).collect()
}
