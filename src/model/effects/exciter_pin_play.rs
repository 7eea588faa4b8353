//! Play of the pin joint: a knock whenever the force changes sign.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, forced, one_node};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "exciter.pin_play",
    layer: Layer::Exciter,
    equation: "knock where M changes sign, as a share of K A",
    strengths: &[Parameter::new("m", "-", 0.05, [-0.5, 0.5])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let size = i.run.inertia_kg_m2 * i.run.natural_rad_s.powi(2) * i.run.amplitude_rad;
    let side = i.rate_rad_per_s.value().signum();
    p[0] * (-(i.moment_n_m / (0.03 * size)).powi(2)).exp() * (side * size)
}
