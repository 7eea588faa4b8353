//! The hand or the hook lets go slowly.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, decays, each};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.slow_release",
    layer: Layer::Tank,
    equation: "s w^2 phi0 exp(-t/tr)",
    strengths: &[Parameter::new("s", "-", 0.2, [0.0, 1.2])],
    shapes: &[Parameter::new("tr", "s", 0.04, [0.015, 0.5])],
    nodes: |_| each(&[0.05, 0.1, 0.2]),
    scope: Scope::Campaign,
    shows: decays,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Zhao et al. 2016",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let held = i.run.natural_rad_s.powi(2) * i.run.initial_roll_rad;
    p[0] * (N::from(-i.time_s) / p[1]).exp() * held
}
