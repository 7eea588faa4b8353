//! The roll channel saturates at the end of its range.

use crate::model::effect::{Acts, Effect, Layer, Parameter, Scope, any_run, each};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.clipping",
    layer: Layer::Instrument,
    equation: "phi between -c and c",
    strengths: &[Parameter::new("s", "-", 1.0, [0.8, 1.2])],
    shapes: &[Parameter::new("c", "rad", 0.0, [0.02, 1.0])],
    nodes: |run| run.flat_top_rad.map_or(Vec::new(), |top| each(&[top])),
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(|all, p| all.iter().map(|i| p[0] * beyond(i.roll_rad, p[1])).collect()),
    always_equivalent: &[],
    reference: "data sheets",
};

fn beyond(roll_rad: f64, end_rad: f64) -> f64 {
    roll_rad.clamp(-end_rad, end_rad) - roll_rad
}
