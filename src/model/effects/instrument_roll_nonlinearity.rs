//! The potentiometer errs by a fixed function of the angle.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, any_run, each,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_nonlinearity",
    layer: Layer::Instrument,
    equation: "phi + e1 sin(2 pi phi/L) + e2 (cos(2 pi phi/L) - 1)",
    strengths: &[
        Parameter::new("e1", "rad", 0.0012, [-0.008, 0.008]),
        Parameter::new("e2", "rad", 0.0012, [-0.008, 0.008]),
    ],
    shapes: &[Parameter::new("L", "rad", 0.05, [0.1, 0.9])],
    nodes: |_| each(&[0.14, 0.2, 0.28, 0.4]),
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &[],
    reference: "Bourns, Novotechnik: independent linearity",
};

fn error<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let (sin, cos) = (i.roll_rad / p[2] * std::f64::consts::TAU).sin_cos();
    p[0] * sin + p[1] * (cos - 1.0)
}

fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    all.iter().map(|i| error(i, p)).collect()
}
