//! The flow of the first swings is not yet that of a rolling model.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, decays, each};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.start_up",
    layer: Layer::Damping,
    equation: "-be b1 exp(-t/T) phi'",
    strengths: &[Parameter::new("be", "-", 0.3, [-0.3, 0.9])],
    shapes: &[Parameter::new("T", "s", 0.7, [0.3, 6.0])],
    nodes: |run| {
        let period_s = std::f64::consts::TAU / run.natural_rad_s;
        each(&[period_s, 2.0 * period_s])
    },
    scope: Scope::Condition,
    shows: decays,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "van 't Veer & Fathi 2010; Zhao et al. 2016",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    p[0] * (N::from(-i.time_s) / p[1]).exp() * i.rate_rad_per_s * i.b1_per_s
}
