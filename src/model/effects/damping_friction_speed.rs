//! Bearing friction that the resistance of the towed model presses up, with the speed squared.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, each, under_way};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.friction_speed",
    layer: Layer::Damping,
    equation: "f (Fr/0.4)^2 tanh(phi'/ve), f = Mf/(I+dI) at Fr 0.4",
    strengths: &[Parameter::new("f", "rad/s2", 0.02, [0.0, 0.2])],
    shapes: &[Parameter::new("ve", "rad/s", 0.01, [0.002, 0.1])],
    nodes: |_| each(&[0.02]),
    scope: Scope::Campaign,
    shows: under_way,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "mechanics: friction in proportion to the load",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * (i.rate_rad_per_s / p[1]).tanh() * f64::powi(i.run.froude / 0.4, 2)
}
