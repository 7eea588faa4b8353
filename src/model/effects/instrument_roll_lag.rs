//! A low-pass filter makes the roll channel lag.

use crate::model::effect::{
    Acts, Effect, Instant, Layer, Parameter, Reading, Scope, any_run, one_node,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.roll_lag",
    layer: Layer::Instrument,
    equation: "tau z' = phi - z",
    strengths: &[Parameter::new("tau", "s", 0.015, [0.0, 0.09])],
    shapes: &[],
    nodes: one_node,
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Roll(Reading { plain: lag, sloped: lag }),
    always_equivalent: &[],
    reference: "filter theory",
};

/// First-order lag of a course whose rate is straight between samples: of `phi' = r + a t` it lacks
/// `-tau phi' + tau^2 a`, once what it began with has faded.
fn lag<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let tau_s = p[0];
    let Some(first) = all.first() else { return Vec::new() };
    // The filter has long run: the series of what it lacks, the fourth derivative left out.
    let third = first.rate_rad_per_s * -first.run.rolling_rad_s.powi(2);
    let mut behind = tau_s * (tau_s * (first.acceleration_rad_per_s2 - tau_s * third))
        - tau_s * first.rate_rad_per_s;
    let mut lost = vec![behind];
    for pair in all.windows(2) {
        let step_s = pair[1].time_s - pair[0].time_s;
        let [before, after] = [pair[0].rate_rad_per_s, pair[1].rate_rad_per_s];
        let bend = tau_s * tau_s * ((after - before) / step_s);
        let fades =
            if tau_s.value() > 0.0 { (N::from(-step_s) / tau_s).exp() } else { N::from(0.0) };
        behind = bend - tau_s * after + (behind + tau_s * before - bend) * fades;
        lost.push(behind);
    }
    lost
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::effect::Circumstances;
    use crate::model::term::tests::{run, swing};
    use crate::run::RunKind;

    #[test]
    fn a_short_lag_of_a_sine_is_that_of_the_filter_however_coarse_the_samples() {
        // `phi = sin w t` leaves the filter as `Im exp(i w t) / (1 + i w tau)`.
        let (rad_s, tau_s, step_s) = (10.0_f64, 1e-3, 0.02);
        let run = Circumstances { rolling_rad_s: rad_s, ..run(RunKind::Forced) };
        let all = swing(&run, 200, step_s);
        let slow = rad_s * tau_s;
        for (instant, lost) in all.iter().zip(lag(&all, &[tau_s])) {
            let (sin, cos) = (rad_s * instant.time_s).sin_cos();
            let exact = (sin - slow * cos) / (1.0 + slow * slow) - sin;
            assert!((lost - exact).abs() < 2e-3 * slow, "{lost} for {exact}");
        }
    }
}
