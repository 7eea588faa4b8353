//! Sway, yaw or the towing frame give way and roll with the model.

use crate::model::effect::{
    Acts, Effect, Instant, Lag, LagLaw, Layer, MOST_LAGS, Parameter, Scope, any_run, each,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.coupled_mode",
    layer: Layer::Tank,
    equation: "y'' + 2 z v y' + v^2 y = -phi'', moment -mu y''",
    strengths: &[Parameter::new("mu", "-", 0.03, [0.0, 0.3])],
    shapes: &[Parameter::new("v", "rad/s", 4.0, [6.0, 80.0])],
    nodes: |_| each(&[8.0, 10.0, 12.5, 15.5, 17.5, 19.5, 22.0, 25.0, 30.0, 38.0]),
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Lagging(Lag {
        n_states: 2,
        is_stirred: false,
        slope: LagLaw { plain: slope, sloped: slope },
        moment: LagLaw { plain: moment, sloped: moment },
    }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-04.5: captured or partly captured models",
};

/// Damping ratio of the mode that gives way [-].
const RATIO: f64 = 0.05;

fn slope<N: Number>(i: &Instant<'_, N>, p: &[N], z: &[N]) -> [N; MOST_LAGS] {
    let v = p[1];
    [z[1], -v * z[1] * (2.0 * RATIO) - v * v * z[0] - i.acceleration_rad_per_s2]
}

fn moment<N: Number>(i: &Instant<'_, N>, p: &[N], z: &[N]) -> N {
    -p[0] * slope(i, p, z)[1]
}
