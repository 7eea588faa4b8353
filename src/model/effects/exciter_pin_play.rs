//! Play of the pin joint: the force rings whenever it changes sign.

use crate::model::effect::{Acts, Effect, Instant, Layer, Parameter, Reading, Scope, forced};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "exciter.pin_play",
    layer: Layer::Exciter,
    equation: "M + m K exp(-t/tr) sin(v t), phi - h sgn M, t since M changed sign",
    strengths: &[
        Parameter::new("m", "rad", 0.01, [-0.2, 0.2]),
        Parameter::new("h", "rad", 0.0002, [-0.002, 0.002]),
    ],
    shapes: &[
        Parameter::new("tr", "s", 0.02, [0.005, 0.3]),
        Parameter::new("v", "rad/s", 30.0, [40.0, 600.0]),
    ],
    nodes: |_| [60.0, 100.0, 150.0, 220.0, 320.0].map(|ringing| vec![0.05, ringing]).to_vec(),
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Chain(
        Reading { plain: behind, sloped: behind },
        Reading { plain: ringing, sloped: ringing },
    ),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

/// Time in which the play closes after a reversal [s]; taken as known, for a roll that is read
/// every hundredth of a second hardly shows it.
const CLOSING_S: f64 = 0.01;

/// The roll behind the rod by half the play, on the side to which the rod pushes.
fn behind<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let at = |(i, since_s): (&Instant<'_, N>, N)| {
        let open = (-since_s / CLOSING_S).exp();
        p[1] * (open * 2.0 - N::from(1.0)) * i.moment_n_m.value().signum()
    };
    all.iter().zip(since_reversals(all)).map(at).collect()
}

/// The moment of the ringing.
fn ringing<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let at = |(i, since_s): (&Instant<'_, N>, N)| {
        let (ringing, _) = (p[3] * since_s).sin_cos();
        // The gap closes against the contact's stiffness, whatever the roll: play, stiffness and
        // arm make one moment, told as a share of the restoring of a radian.
        let restoring = i.run.inertia_kg_m2 * i.run.natural_rad_s.powi(2);
        p[0] * (-since_s / p[2]).exp() * ringing * (restoring * i.moment_n_m.value().signum())
    };
    all.iter().zip(since_reversals(all)).map(at).collect()
}

/// Time since the moment changed its sign [s], at each instant; before the first change of the
/// record since half a period of the rod before that.
fn since_reversals<N: Number>(all: &[Instant<'_, N>]) -> Vec<N> {
    let changes = |pair: &[Instant<'_, N>]| {
        let [before, after] = [pair[0].moment_n_m, pair[1].moment_n_m];
        let is_change = before.value() * after.value() < 0.0;
        let step_s = pair[1].time_s - pair[0].time_s;
        is_change.then(|| before / (before - after) * step_s + N::from(pair[0].time_s))
    };
    let Some(first) = all.windows(2).find_map(changes) else {
        return all.iter().map(|i| N::from(i.time_s)).collect();
    };
    let half_period_s = std::f64::consts::PI / all[0].run.rolling_rad_s;
    let mut last = first - N::from(half_period_s);
    let mut since = vec![N::from(all[0].time_s) - last];
    for pair in all.windows(2) {
        last = changes(pair).unwrap_or(last);
        since.push(N::from(pair[1].time_s) - last);
    }
    since
}
