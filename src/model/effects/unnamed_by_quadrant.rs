//! Damping that differs from quadrant to quadrant of roll and rate, of whatever cause.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// Roll [rad] within which one side passes into the other.
const PASSING_RAD: f64 = 0.005;

/// The law.
pub(super) const EFFECT: Effect = Effect {
    id: "unnamed.by_quadrant",
    layer: Layer::Damping,
    equation: "(b + bp sgn(phi) + bu sgn(phi') + bq sgn(phi phi')) phi'",
    strengths: &[
        Parameter::new("bp", "1/s", 0.1, [-2.0, 2.0]),
        Parameter::new("bu", "1/s", 0.1, [-2.0, 2.0]),
        Parameter::new("bq", "1/s", 0.1, [-2.0, 2.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "the parities of a moment in roll and rate",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let side = (i.roll_rad / PASSING_RAD).tanh();
    let (rate, size) = (i.rate_rad_per_s, i.rate_rad_per_s.abs());
    -(p[0] * side * rate + p[1] * size + p[2] * side * size)
}
