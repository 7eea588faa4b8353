//! The arm of the rod shortens with the roll and the moment is taken as if it did not.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, forced, one_node};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "exciter.arm_geometry",
    layer: Layer::Exciter,
    equation: "M/(1 - s (1 - cos(phi)))",
    strengths: &[Parameter::new("s", "-", 1.0, [0.3, 2.5])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let (_, cos) = i.roll_rad.sin_cos();
    let arm = N::from(1.0) - p[0] * (N::from(1.0) - cos);
    i.moment_n_m * (N::from(1.0) / arm - 1.0)
}
