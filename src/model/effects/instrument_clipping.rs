//! The roll channel saturates at the end of its range.

use crate::model::effect::{Acts, Effect, Facts, Layer, Parameter, Scope, Seen, any_run, one_node};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.clipping",
    layer: Layer::Instrument,
    equation: "phi between -c and c",
    strengths: &[Parameter::new("c", "rad", 0.2, [0.02, 1.0])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Record(seen),
    always_equivalent: &[],
    reference: "data sheets",
};

/// Crests that are flat where the others of the run are round; their samples take no part in any
/// fit.
fn seen(facts: &Facts) -> Option<Seen> {
    let clip = facts.clip?;
    Some(Seen {
        log_bayes_factor: clip.log_bayes_factor,
        values: vec![(clip.level_rad, clip.sd_rad)],
        recurs: None,
    })
}
