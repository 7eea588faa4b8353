//! Water inside the hull with a free surface.

use crate::model::effect::{
    Acts, Effect, Instant, Lag, LagLaw, Layer, MOST_LAGS, Parameter, Scope, any_run,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "restoring.free_surface",
    layer: Layer::Restoring,
    equation: "psi'' + 2 z wt psi' + wt^2 (psi + phi) = 0, moment -kt w^2 psi",
    strengths: &[Parameter::new("kt", "-", 0.05, [0.0, 0.4])],
    shapes: &[
        Parameter::new("wt/w", "-", 0.1, [0.3, 1.4]),
        Parameter::new("z", "-", 0.05, [0.005, 0.6]),
    ],
    nodes: |_| [0.45, 0.55, 0.65, 0.7, 0.75, 0.8, 0.9, 1.1].map(|share| vec![share, 0.05]).to_vec(),
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Lagging(Lag {
        n_states: 2,
        is_stirred: true,
        slope: LagLaw { plain: slope, sloped: slope },
        moment: LagLaw { plain: moment, sloped: moment },
    }),
    always_equivalent: &[],
    reference: "McTaggart 2011; Moaleji & Greig 2007",
};

/// Rise of the surface against the tank `psi + phi`, level at release, and the surface's rate.
fn slope<N: Number>(i: &Instant<'_, N>, p: &[N], z: &[N]) -> [N; MOST_LAGS] {
    let own_rad_s = p[1] * i.natural_rad_s;
    let rate = z[1];
    [rate + i.rate_rad_per_s, -p[2] * own_rad_s * rate * 2.0 - own_rad_s * own_rad_s * z[0]]
}

fn moment<N: Number>(i: &Instant<'_, N>, p: &[N], z: &[N]) -> N {
    -p[0] * (z[0] - i.roll_rad) * i.natural_rad_s.powi(2)
}
