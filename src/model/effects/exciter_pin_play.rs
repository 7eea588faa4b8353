//! Play of the pin joint: a knock whenever the force changes sign.

use crate::model::effect::{Acts, Effect, Instant, Layer, Parameter, Scope, forced, one_node};

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
    acts: Acts::Drive(law),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

fn law(i: &Instant<'_>, p: &[f64]) -> f64 {
    let size = i.run.inertia_kg_m2 * i.run.natural_rad_s.powi(2) * i.run.amplitude_rad;
    p[0] * size * i.rate_rad_per_s.signum() * (-(i.moment_n_m / (0.03 * size)).powi(2)).exp()
}
