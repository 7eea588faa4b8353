//! Play between the model and its potentiometer.

use crate::model::effect::{Acts, Effect, Instant, Layer, Parameter, Scope, any_run, one_node};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_backlash",
    layer: Layer::Instrument,
    equation: "phi within +-d of the reading",
    strengths: &[Parameter::new("d", "rad", 0.0015, [0.0, 0.01])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(play),
    always_equivalent: &[],
    reference: "python-control: friction and backlash",
};

/// The reading stays until the angle has crossed the play; it starts in contact.
fn play(all: &[Instant<'_>], p: &[f64]) -> Vec<f64> {
    let half = p[0];
    let Some(first) = all.first() else { return Vec::new() };
    let mut reading = first.roll_rad - half * first.roll_rad.signum();
    let mut lost = Vec::with_capacity(all.len());
    for i in all {
        let (low, high) = (i.roll_rad - half.abs(), i.roll_rad + half.abs());
        reading = reading.clamp(low, high);
        lost.push(reading - i.roll_rad);
    }
    lost
}
