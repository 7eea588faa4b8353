//! The carriage has not settled to its speed when the run begins.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, decays, each, under_way,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.unsteady_speed",
    layer: Layer::Tank,
    equation: "2 dv (b1 - b0) exp(-t/T) phi'",
    strengths: &[Parameter::new("dv", "-", 0.08, [-0.4, 0.4])],
    shapes: &[Parameter::new("T", "s", 0.7, [0.4, 8.0])],
    nodes: |_| each(&[1.0, 2.0, 4.0]),
    scope: Scope::Campaign,
    shows: |run| decays(run) && under_way(run),
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "carriage logs",
};

/// Share of the linear damping that speed adds, by the paper's law.
fn share_of_speed(froude: f64) -> f64 {
    let grown = 12.0 * froude * froude;
    grown / (1.0 + grown)
}

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let by_speed_per_s = i.run.b1_per_s * share_of_speed(i.run.froude);
    -p[0] * (N::from(-i.time_s) / p[1]).exp() * i.rate_rad_per_s * (2.0 * by_speed_per_s)
}
