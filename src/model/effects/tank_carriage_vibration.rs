//! The carriage shakes the model at speed.

use crate::model::effect::{
    Acts, Effect, Facts, Layer, Parameter, Recurs, Scope, Seen, one_node, under_way,
};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.carriage_vibration",
    layer: Layer::Tank,
    equation: "phi + h sin(2 pi f t), under way only",
    strengths: &[
        Parameter::new("h", "rad", 0.001, [1e-05, 0.02]),
        Parameter::new("f", "Hz", 10.0, [0.0, 1000.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: under_way,
    acts: Acts::Record(seen),
    always_equivalent: &[],
    reference: "University of Michigan towing carriage",
};

/// A line of a run under way that is none of the mains'.
fn seen(facts: &Facts) -> Option<Seen> {
    let line = facts.line.filter(|_| facts.froude > 0.01)?;
    let values = vec![(line.amplitude_rad, line.amplitude_sd_rad), (line.frequency_hz, 0.05)];
    let recurs = Some(Recurs::PerFroude(line.frequency_hz / facts.froude));
    Some(Seen { log_bayes_factor: line.log_bayes_factor, values, recurs })
}
