//! The zero of the load cell creeps.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, with_moment,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.force_drift",
    layer: Layer::Instrument,
    equation: "M + m0 + d (t + rest)/20 s",
    strengths: &[
        Parameter::new("d", "N m", 0.1, [-2.0, 2.0]),
        Parameter::new("m0", "N m", 0.2, [-5.0, 5.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: with_moment,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "HBM; OIML R60",
};

/// `rest` is the time from the model's last rest to time zero.
fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[1] + p[0] * (i.time_s + i.run.since_rest_s) / 20.0
}
