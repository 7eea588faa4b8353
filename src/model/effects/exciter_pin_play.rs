//! Play of the pin joint: the force rings whenever it changes sign.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, forced};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "exciter.pin_play",
    layer: Layer::Exciter,
    equation: "m K exp(-t/tr) sin(v t), t since M changed sign",
    strengths: &[Parameter::new("m", "rad", 0.01, [-0.2, 0.2])],
    shapes: &[
        Parameter::new("tr", "s", 0.02, [0.005, 0.3]),
        Parameter::new("v", "rad/s", 30.0, [40.0, 600.0]),
    ],
    nodes: |_| [60.0, 100.0, 150.0, 220.0, 320.0].map(|ringing| vec![0.05, ringing]).to_vec(),
    scope: Scope::Campaign,
    shows: forced,
    acts: Acts::Drive(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "geometry of the rig",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let (w, rolling) = (i.run.natural_rad_s, i.run.rolling_rad_s);
    let inertia = i.run.inertia_kg_m2;
    // The moment of a sine tells by its growth how long ago it changed sign.
    let growth = (i.rate_rad_per_s * (w * w - rolling * rolling)
        + i.acceleration_rad_per_s2 * i.run.b1_per_s)
        * inertia;
    let tangent = i.moment_n_m * rolling / growth;
    let angle = tangent.value().atan();
    if angle < 0.0 {
        return N::from(0.0);
    }
    let since_s = tangent.chain(angle, (1.0 + tangent.value().powi(2)).recip()) / rolling;
    let (ringing, _) = (p[2] * since_s).sin_cos();
    // The gap closes against the contact's stiffness, whatever the roll: play, stiffness and arm
    // make one moment, told as a share of the restoring of a radian.
    let size = inertia * w * w * growth.value().signum();
    // Gone by the time the moment turns, whatever is left of the ringing.
    let fading = (tangent * tangent + 1.0).powf(N::from(-0.5));
    p[0] * (-since_s / p[1]).exp() * ringing * fading * size
}
