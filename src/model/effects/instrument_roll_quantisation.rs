//! The roll channel can only read steps that are coarse beside its noise.

use crate::model::effect::{Acts, Effect, Facts, Layer, Parameter, Scope, Seen, any_run, one_node};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_quantisation",
    layer: Layer::Instrument,
    equation: "phi rounded to q",
    strengths: &[Parameter::new("q", "rad", 0.002, [0.0007, 0.02])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Record(seen),
    always_equivalent: &[],
    reference: "data sheets of converters and wirewound potentiometers",
};

/// Coarsest step [rad] that every converter has and nobody minds.
const FINE_RAD: f64 = 0.0007;

/// Readings that all lie on a lattice do so by chance once in many worlds.
fn seen(facts: &Facts) -> Option<Seen> {
    let quantum_rad = facts.quantum_rad.filter(|q| *q >= FINE_RAD)?;
    let sd_rad = quantum_rad * 1e-3;
    let log_bayes_factor = facts.n_samples as f64;
    Some(Seen { log_bayes_factor, values: vec![(quantum_rad, sd_rad)], recurs: None })
}
