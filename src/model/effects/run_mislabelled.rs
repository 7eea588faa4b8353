//! One run carries the label of another: its Froude number, condition or unit is wrong.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "run.mislabelled",
    layer: Layer::Instrument,
    equation: "db b1 phi' + dk w^2 phi in this run alone",
    strengths: &[
        Parameter::new("db", "-", 0.7, [-0.95, 20.0]),
        Parameter::new("dk", "-", 0.1, [-0.5, 2.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Run,
    shows: |run| run.n_runs >= 5,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "the seed paper itself: Table 2",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let w = i.run.natural_rad_s;
    -p[0] * i.rate_rad_per_s * i.run.b1_per_s - p[1] * i.roll_rad * (w * w)
}
