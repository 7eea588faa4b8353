//! A power law of the rate that is no whole power, as drag against Keulegan-Carpenter number gives.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, each};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.power_law",
    layer: Layer::Damping,
    equation: "bp phi'|phi'/(w 10 deg)|^(p-1)",
    strengths: &[Parameter::new("bp", "1/s", 0.2, [0.0, 2.0])],
    shapes: &[Parameter::new("p", "-", 0.2, [1.2, 2.6])],
    nodes: |_| each(&[1.4, 1.67, 2.4]),
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Graham 1980; ITTC 7.5-02-07-04.5",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let share = i.rate_rad_per_s.abs() / (i.run.natural_rad_s * 10_f64.to_radians());
    -p[0] * i.rate_rad_per_s * share.max(N::from(1e-9)).powf(p[1] - 1.0)
}
