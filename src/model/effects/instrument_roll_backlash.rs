//! Play between the model and its potentiometer.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, any_run, one_node,
};
use crate::model::number::Number;

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
    acts: Acts::Roll(Reading { plain: play, sloped: play }),
    always_equivalent: &[],
    reference: "python-control: friction and backlash",
};

/// Rate as a share of that of a roll through its rest, from which the play behind it is crossed.
const MOVING: f64 = 0.3;

/// The reading stays until the angle has crossed the play; it starts in contact, behind a model
/// that moves, and as heeling left it behind one that is held.
fn play<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let half = p[0];
    let Some(first) = all.first() else { return Vec::new() };
    let (roll, rate) = (first.roll_rad.value(), first.rate_rad_per_s.value());
    let moves = rate.abs() > MOVING * first.run.natural_rad_s * roll.abs();
    let ahead = if moves { rate } else { roll };
    let mut reading = first.roll_rad - half * ahead.signum();
    let mut lost = Vec::with_capacity(all.len());
    for i in all {
        let (low, high) = (i.roll_rad - half.abs(), i.roll_rad + half.abs());
        reading = reading.max(low).min(high);
        lost.push(reading - i.roll_rad);
    }
    lost
}
