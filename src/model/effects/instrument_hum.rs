//! A line that is there whatever the model does, as mains make it.

use crate::model::effect::{
    Acts, Effect, Facts, Layer, Parameter, Recurs, Scope, Seen, any_run, one_node,
};

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.hum",
    layer: Layer::Instrument,
    equation: "phi + h sin(2 pi f t)",
    strengths: &[
        Parameter::new("h", "rad", 0.001, [1e-05, 0.02]),
        Parameter::new("f", "Hz", 50.0, [0.0, 1000.0]),
    ],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Record(seen),
    always_equivalent: &[],
    reference: "sampling theory: mains alias",
};

/// A line in a run at rest is hum; at speed it may be the carriage, which another effect judges.
fn seen(facts: &Facts) -> Option<Seen> {
    let line = facts.line?;
    let values = vec![(line.amplitude_rad, line.amplitude_sd_rad), (line.frequency_hz, 0.05)];
    let is_near = |hz: f64| (hz - line.frequency_hz).abs() < MAINS_OFF_HZ;
    let is_mains = mains_hz(facts.sample_rate_hz).into_iter().any(is_near);
    let log_bayes_factor =
        if is_mains || facts.froude < 0.01 { line.log_bayes_factor } else { -1.0 };
    Some(Seen { log_bayes_factor, values, recurs: Some(Recurs::Fixed(line.frequency_hz)) })
}

/// How far a line of the mains may be off [Hz].
pub const MAINS_OFF_HZ: f64 = 0.3;

/// Where the mains, and the double of those of Europe, show when sampled at a rate [Hz].
pub fn mains_hz(sample_rate_hz: f64) -> [f64; 3] {
    [50.0, 60.0, 100.0].map(|hz| folded(hz, sample_rate_hz))
}

/// Where a frequency shows when sampled at `rate_hz`.
fn folded(hz: f64, rate_hz: f64) -> f64 {
    let rest = hz.rem_euclid(rate_hz);
    rest.min(rate_hz - rest)
}
