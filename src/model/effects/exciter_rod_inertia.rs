//! The rod and what hangs on it are moved by the load cell as well.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, forced, one_node};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "exciter.rod_inertia",
    layer: Layer::Exciter,
    equation: "M + r (I+dI) phi''",
    strengths: &[Parameter::new("r", "-", 0.01, [0.0, 0.06])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "mechanics",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[0] * i.acceleration_rad_per_s2 * i.run.inertia_kg_m2
}
