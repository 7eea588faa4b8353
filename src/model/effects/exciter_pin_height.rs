//! The pin joint lies above or below the roll axis.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, forced, one_node};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "exciter.pin_height",
    layer: Layer::Exciter,
    equation: "M/(1 - (h/l) sin(phi))",
    strengths: &[Parameter::new("h/l", "-", 0.25, [-0.9, 0.9])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let (sin, _) = i.roll_rad.sin_cos();
    i.moment_n_m * (N::from(1.0) / (N::from(1.0) - p[0] * sin) - 1.0)
}
