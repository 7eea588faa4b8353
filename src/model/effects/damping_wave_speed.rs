//! Wave damping has a hump where the waves that rolling makes travel with the model.

use crate::model::effect::{
    Acts, Effect, Instant, Law, Layer, Parameter, Scope, one_node, under_way,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.wave_speed",
    layer: Layer::Damping,
    equation: "bw exp(-150 (w V/g - 1/4)^2) phi'",
    strengths: &[Parameter::new("bw", "1/s", 0.2, [0.0, 1.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Condition,
    shows: under_way,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Ikeda; ITTC 7.5-02-07-04.5",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let tau = i.run.rolling_rad_s * i.run.speed_m_s / i.run.gravity_m_s2;
    -p[0] * i.rate_rad_per_s * f64::exp(-150.0 * (tau - 0.25).powi(2))
}
