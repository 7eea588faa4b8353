//! Waves that the model made come back from the tank walls.

use crate::model::effect::{
    Acts, Circumstances, Effect, Instant, Law, Layer, Parameter, Scope, each,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.wall_reflection",
    layer: Layer::Tank,
    equation: "r1 phi'(t - td) + r2 w phi(t - td)",
    strengths: &[
        Parameter::new("r1", "1/s", 0.1, [-1.0, 1.0]),
        Parameter::new("r2", "1/s", 0.1, [-1.0, 1.0]),
    ],
    shapes: &[Parameter::new("td", "s", 0.3, [3.0, 60.0])],
    nodes: delays,
    scope: Scope::Campaign,
    shows: in_reach,
    acts: Acts::Echo(Law { plain: law, sloped: law }, 2),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-02.1: tank interference",
};

/// Waves of the model reach its sides again only below this `w V/g` [-].
const LIMIT: f64 = 0.305;

fn in_reach(run: &Circumstances) -> bool {
    run.rolling_rad_s * run.speed_m_s / run.gravity_m_s2 < LIMIT
}

/// Round trip at the group velocity `g/(2 w)` in deep water.
fn delays(run: &Circumstances) -> Vec<Vec<f64>> {
    match run.clear_width_m {
        Some(width_m) => {
            let trip_s = width_m * 2.0 * run.natural_rad_s / run.gravity_m_s2;
            let half_period_s = std::f64::consts::PI / run.natural_rad_s;
            let n = (0.7 * trip_s / half_period_s).round().max(1.0) as usize;
            let node = |k: usize| trip_s * (0.6 + 0.7 * k as f64 / n as f64);
            each(&(0..=n).map(node).collect::<Vec<_>>())
        }
        None => each(&[8.0, 10.0, 12.0, 14.0, 17.0, 20.0]),
    }
}

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let [roll_rad, rate_rad_per_s] = i.ago(p[2]);
    p[0] * rate_rad_per_s + p[1] * roll_rad * i.run.natural_rad_s
}
