//! Radiation memory: waves made earlier still press on the hull.

use crate::model::effect::{
    Acts, Effect, Instant, Lag, LagLaw, Layer, MOST_LAGS, Parameter, Scope, any_run,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.memory",
    layer: Layer::Damping,
    equation: "mu(s) = bm a1 s/(s^2 + a1 s + (q w)^2) phi'",
    strengths: &[Parameter::new("bm", "1/s", 0.15, [0.0, 0.8])],
    shapes: &[
        Parameter::new("q", "-", 0.15, [0.6, 2.0]),
        Parameter::new("a1", "1/s", 2.0, [1.0, 15.0]),
    ],
    nodes: |_| vec![vec![0.9, 5.0], vec![1.1, 5.0], vec![1.3, 5.0]],
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Lagging(Lag {
        n_states: 2,
        is_stirred: false,
        slope: LagLaw { plain: slope, sloped: slope },
        moment: LagLaw { plain: moment, sloped: moment },
    }),
    always_equivalent: &[],
    reference: "Cummins 1962; Perez & Fossen 2008",
};

fn slope<N: Number>(i: &Instant<'_, N>, p: &[N], z: &[N]) -> [N; MOST_LAGS] {
    let own_rad_s = p[1] * i.natural_rad_s;
    [z[1], i.rate_rad_per_s - p[2] * z[1] - own_rad_s * own_rad_s * z[0]]
}

fn moment<N: Number>(_: &Instant<'_, N>, p: &[N], z: &[N]) -> N {
    -p[0] * p[2] * z[1]
}
