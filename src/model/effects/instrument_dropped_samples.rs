//! Samples were lost and the time stamps do not tell.

use crate::model::effect::{
    Acts, Circumstances, Effect, Instant, Layer, Parameter, Reading, Scope, any_run,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.dropped_samples",
    layer: Layer::Instrument,
    equation: "phi(t + d) from one instant on",
    strengths: &[Parameter::new("d", "s", 0.03, [0.004, 0.3])],
    shapes: &[Parameter::new("t0", "s", 0.0, [0.0, 10000.0]).at_once()],
    nodes: onsets,
    scope: Scope::Run,
    shows: any_run,
    acts: Acts::Roll(Reading { plain: adds, sloped: adds }),
    always_equivalent: &[],
    reference: "serial links without sample counters",
};

/// Every quarter period of the run.
fn onsets(run: &Circumstances) -> Vec<Vec<f64>> {
    let quarter_s = 0.25 * std::f64::consts::TAU / run.rolling_rad_s;
    let n = ((run.span_s / quarter_s) as usize).min(80);
    (1..n).map(|k| vec![run.span_s * k as f64 / n as f64]).collect()
}

fn ahead<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    if i.time_s < p[1].value() {
        return N::from(0.0);
    }
    p[0] * (i.rate_rad_per_s + p[0] * i.acceleration_rad_per_s2 * 0.5)
}

fn adds<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    all.iter().map(|i| ahead(i, p)).collect()
}
