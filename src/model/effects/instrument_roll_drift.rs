//! The zero of the roll channel drifts.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_drift",
    layer: Layer::Instrument,
    equation: "phi + e0 + d (t + rest)/20 s",
    strengths: &[
        Parameter::new("d", "rad", 0.002, [-0.02, 0.02]),
        Parameter::new("e0", "rad", 0.003, [-0.05, 0.05]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &[],
    reference: "sensor data sheets",
};

/// `rest` is the time from the model's last rest to time zero.
fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    all.iter().map(|i| p[1] + p[0] * (i.time_s + i.run.since_rest_s) / 20.0).collect()
}
