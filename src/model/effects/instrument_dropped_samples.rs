//! Samples were lost and the time stamps do not tell.

use crate::model::effect::{
    Acts, Circumstances, Effect, Instant, Layer, Parameter, Reading, Scope, any_run,
};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "instrument.dropped_samples",
    layer: Layer::Instrument,
    equation: "phi(t + d), M(t + dM) from one instant on",
    strengths: &[
        Parameter::new("d", "s", 0.03, [0.004, 0.3]),
        // A port of its own may have lost none.
        Parameter::new("dM", "s", 0.03, [0.0, 0.3]),
    ],
    shapes: &[Parameter::new("t0", "s", 0.0, [0.0, 10000.0]).at_once()],
    nodes: onsets,
    scope: Scope::Run,
    shows: any_run,
    acts: Acts::Chain(
        Reading { plain: roll, sloped: roll },
        Reading { plain: moment, sloped: moment },
    ),
    always_equivalent: &[],
    reference: "serial links without sample counters",
};

/// Every quarter period of the run.
fn onsets(run: &Circumstances) -> Vec<Vec<f64>> {
    let quarter_s = 0.25 * std::f64::consts::TAU / run.rolling_rad_s;
    let n = ((run.span_s / quarter_s) as usize).min(80);
    (1..n).map(|k| vec![run.span_s * k as f64 / n as f64]).collect()
}

fn roll<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let course = |k: usize| {
        let i: &Instant<'_, N> = &all[k];
        [i.roll_rad, i.rate_rad_per_s, i.acceleration_rad_per_s2]
    };
    ahead(all, p[0], p[2].value(), course)
}

fn moment<N: Number>(all: &[Instant<'_, N>], p: &[N]) -> Vec<N> {
    let course = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(all.len() - 1));
        let span_s = (all[after].time_s - all[before].time_s).max(f64::MIN_POSITIVE);
        let value = all[k].moment_n_m;
        let slope = (all[after].moment_n_m - all[before].moment_n_m) / span_s;
        [value, slope, value * -all[k].run.rolling_rad_s.powi(2)]
    };
    ahead(all, p[1], p[2].value(), course)
}

/// What a channel reads too much from an instant on, where it reads what comes `lead` [s] later;
/// its course is value, slope and curvature at each of the instants.
fn ahead<N: Number>(
    all: &[Instant<'_, N>],
    lead: N,
    from_s: f64,
    course: impl Fn(usize) -> [N; 3],
) -> Vec<N> {
    let Some(last) = all.len().checked_sub(1) else { return Vec::new() };
    let mut next = 0;
    let at = |k: usize| {
        if all[k].time_s < from_s {
            return N::from(0.0);
        }
        let later_s = lead + all[k].time_s;
        while next < last && all[next].time_s <= later_s.value() {
            next += 1;
        }
        let known = next.saturating_sub(1);
        let (since, here) = (later_s - all[known].time_s, course(known));
        let step_s = all[next].time_s - all[known].time_s;
        let later = if next == known || later_s.value() > all[next].time_s {
            here[0] + since * (here[1] + since * here[2] * 0.5)
        } else {
            between(here, course(next), since / step_s, step_s)
        };
        later - course(k)[0]
    };
    (0..all.len()).map(at).collect()
}

/// The course at a share of a step, by Hermite's cubic.
fn between<N: Number>(here: [N; 3], there: [N; 3], share: N, step_s: f64) -> N {
    let rises = there[0] - here[0];
    let bends = share * (N::from(1.0) - share);
    let off =
        (here[1] * step_s - rises) * (N::from(1.0) - share) - (there[1] * step_s - rises) * share;
    here[0] + rises * share + bends * off
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::term::tests::{run, swing};
    use crate::run::RunKind;

    #[test]
    fn both_channels_read_what_comes_later_from_the_gap_on() {
        let rad_s = 6.0_f64;
        let run = Circumstances { rolling_rad_s: rad_s, ..run(RunKind::Forced) };
        let all = swing(&run, 200, 0.02);
        let lost = [0.044, 0.031, 2.0];
        for ((i, roll), moment) in all.iter().zip(roll(&all, &lost)).zip(moment(&all, &lost)) {
            let is_lost = i.time_s >= lost[2];
            let later = |lead: f64, of: fn(f64) -> f64| {
                let gap = of(rad_s * (i.time_s + lead)) - of(rad_s * i.time_s);
                if is_lost { gap } else { 0.0 }
            };
            // Behind the last instant a parabola goes on, a third order of 0.26 rad off.
            let allowed = 5e-3;
            assert!((roll - later(lost[0], f64::sin)).abs() < allowed, "{roll} at {}", i.time_s);
            assert!((moment - later(lost[1], f64::cos)).abs() < allowed, "{moment}");
        }
    }
}
