//! Drag that lags behind the rate, as shed vortices linger.

use crate::model::effect::{
    Acts, Effect, Instant, Lag, Layer, MOST_LAGS, Parameter, Scope, any_run, each,
};

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
    acts: Acts::Lagging(Lag { n_states: 1, slope, moment: |_, p, z| -p[0] * z[0] }),
    always_equivalent: &[],
    reference: "van 't Veer & Fathi 2010",
};

fn slope(i: &Instant<'_>, p: &[f64], z: &[f64]) -> [f64; MOST_LAGS] {
    [(i.rate_rad_per_s * i.rate_rad_per_s.abs() - z[0]) / p[1].max(0.01), 0.0]
}
