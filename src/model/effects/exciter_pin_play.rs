//! Play of the pin joint: the force rings whenever it changes sign.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, forced};
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
        Law { plain: behind, sloped: behind },
        Law { plain: ringing, sloped: ringing },
    ),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

/// Time in which the play closes after a reversal [s]; taken as known, for a roll that is read
/// every hundredth of a second hardly shows it.
const CLOSING_S: f64 = 0.01;

/// The roll behind the rod by half the play, on the side to which the rod pushes.
fn behind<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let side = i.moment_n_m.value().signum();
    let open = (-since_reversal(i) / CLOSING_S).exp();
    p[1] * (open * 2.0 - N::from(1.0)) * side
}

/// The moment of the ringing.
fn ringing<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let w = i.run.natural_rad_s;
    let since_s = since_reversal(i);
    let (ringing, _) = (p[3] * since_s).sin_cos();
    // The gap closes against the contact's stiffness, whatever the roll: play, stiffness and arm
    // make one moment, told as a share of the restoring of a radian.
    let size = i.run.inertia_kg_m2 * w * w * i.moment_n_m.value().signum();
    p[0] * (-since_s / p[2]).exp() * ringing * size
}

/// Time since the moment changed its sign [s]: that of a sine tells by its growth how long ago.
fn since_reversal<N: Number>(i: &Instant<'_, N>) -> N {
    let rolling = i.run.rolling_rad_s;
    let stiffness = i.natural_rad_s * i.natural_rad_s;
    let restoring = i.run.inertia_kg_m2 * i.run.natural_rad_s.powi(2);
    let growth = (i.rate_rad_per_s * (stiffness - rolling * rolling)
        + i.acceleration_rad_per_s2 * i.b1_per_s)
        * restoring
        / stiffness;
    let tangent = i.moment_n_m * rolling / growth;
    let angle = tangent.value().atan();
    // From the crest on the moment falls until its next change of sign.
    let since = if angle < 0.0 { angle + std::f64::consts::PI } else { angle };
    tangent.chain(since, (1.0 + tangent.value().powi(2)).recip()) / rolling
}
