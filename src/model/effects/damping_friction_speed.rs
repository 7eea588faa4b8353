//! Bearing friction that the resistance of the towed model presses up, with the speed squared.

use crate::model::effect::{Acts, Effect, Instant, Layer, Parameter, Scope, each, under_way};

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
    acts: Acts::Moment(law),
    always_equivalent: &[],
    reference: "mechanics: friction in proportion to the load",
};

fn law(i: &Instant<'_>, p: &[f64]) -> f64 {
    -p[0] * (i.run.froude / 0.4).powi(2) * (i.rate_rad_per_s / p[1]).tanh()
}
