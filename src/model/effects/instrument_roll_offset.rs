//! The roll channel does not read nil upright.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_offset",
    layer: Layer::Instrument,
    equation: "phi + e0",
    strengths: &[Parameter::new("e0", "rad", 0.003, [-0.05, 0.05])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &["restoring.heel"],
    reference: "calibration",
};

fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    vec![p[0]; all.len()]
}
