//! Drag that lags behind the rate, as shed vortices linger.

use crate::model::effect::{
    Acts, Effect, Instant, Lag, LagLaw, Layer, MOST_LAGS, Parameter, Scope, any_run, each,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.vortex_history",
    layer: Layer::Damping,
    equation: "b2 z, tau z' = phi'|phi'| - z",
    strengths: &[Parameter::new("b2", "1/rad", 0.4, [0.0, 2.0])],
    shapes: &[Parameter::new("tau", "s", 0.06, [0.02, 0.6])],
    nodes: |_| each(&[0.06, 0.12, 0.25]),
    scope: Scope::Condition,
    shows: any_run,
    acts: Acts::Lagging(Lag {
        n_states: 1,
        is_stirred: false,
        slope: LagLaw { plain: slope, sloped: slope },
        moment: LagLaw { plain: moment, sloped: moment },
    }),
    always_equivalent: &[],
    reference: "van 't Veer & Fathi 2010",
};

fn slope<N: Number>(i: &Instant<'_, N>, p: &[N], z: &[N]) -> [N; MOST_LAGS] {
    [(i.rate_rad_per_s * i.rate_rad_per_s.abs() - z[0]) / p[1].max(N::from(0.01)), N::from(0.0)]
}

fn moment<N: Number>(_: &Instant<'_, N>, p: &[N], z: &[N]) -> N {
    -p[0] * z[0]
}
