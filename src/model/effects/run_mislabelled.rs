//! One run carries the label of another: its Froude number, condition or unit is wrong.

use crate::model::Base;
use crate::model::effect::{
    Acts, Circumstances, Effect, Instant, Law, Layer, Parameter, Scope, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "run.mislabelled",
    layer: Layer::Instrument,
    equation: "db b1 phi' + dk w^2 phi in this run alone",
    // `b1` is what the run itself shows: a law of many times as much is as likely as one of none.
    strengths: &[
        Parameter::new("db", "-", 0.7, [-20.0, 2.0]),
        Parameter::new("dk", "-", 0.1, [-0.5, 2.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::OddRun,
    shows: |run| run.n_runs >= 4,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "the seed paper itself: Table 2",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let w = i.run.natural_rad_s;
    -p[0] * i.rate_rad_per_s * i.run.b1_per_s - p[1] * i.roll_rad * (w * w)
}

/// The base equation that reads with this effect as `base` reads without.
pub(super) fn exchanged(base: &Base, run: &Circumstances, p: &[f64]) -> Base {
    let stiffness = base.natural_rad_s.powi(2) - p[1] * run.natural_rad_s.powi(2);
    Base {
        natural_rad_s: stiffness.max(0.0).sqrt(),
        b1_per_s: base.b1_per_s - p[0] * run.b1_per_s,
        ..*base
    }
}
