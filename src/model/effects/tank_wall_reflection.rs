//! Waves that the model made come back from the tank walls, the long ones first.

use crate::model::echo::{Tap, Taps, times};
use crate::model::effect::{Acts, Circumstances, Effect, Layer, Parameter, Scope, each};
use crate::model::number::Number;
use crate::roll::wall_waves;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.wall_reflection",
    layer: Layer::Tank,
    equation: "(1 - w V/(0.305 g)) (r1 Re E + r2 Im E), E = phi' through exp(-i w^2 D/g)",
    strengths: &[
        Parameter::new("r1", "1/s", 0.1, [-1.0, 1.0]),
        Parameter::new("r2", "1/s", 0.1, [-1.0, 1.0]),
    ],
    shapes: &[Parameter::new("td", "s", 1.0, [3.0, 60.0]).held_to(log_odds_of_trip)],
    nodes: delays,
    scope: Scope::Campaign,
    shows: in_reach,
    acts: Acts::Echo(Taps { plain: taps, sloped: taps }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-02.1: tank interference; deep-water dispersion",
};

/// `w V/g` over its limit.
fn outrun(run: &Circumstances) -> f64 {
    wall_waves::outrun(run.rolling_rad_s, run.speed_m_s, run.gravity_m_s2)
}

fn in_reach(run: &Circumstances) -> bool {
    outrun(run) < 1.0
}

/// Trips that are tried, as shares of that of the middle of the tank.
const SHARES: [f64; 8] = [0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3];
/// Share to which a model's place amid the tank makes its trip known.
const TRIP_KNOWN: f64 = 0.15;

/// Round trips at the group velocity `g/(2 w)` in deep water, as far apart as an echo is wide.
fn delays(run: &Circumstances) -> Vec<Vec<f64>> {
    match run.clear_width_m {
        Some(width_m) => {
            let trip_s = wall_waves::trip_s(width_m, run.natural_rad_s, run.gravity_m_s2);
            each(&SHARES.map(|share| share * trip_s))
        }
        None => each(&[8.0, 10.0, 12.0, 14.0, 17.0, 20.0]),
    }
}

/// Logarithm of the odds that an echo after `delay_s` [s], known to `sd_s` [s], is back from the
/// walls, against any of the trips that are tried as likely; nil where the width is not known.
fn log_odds_of_trip(run: &Circumstances, delay_s: f64, sd_s: f64) -> f64 {
    let Some(width_m) = run.clear_width_m else { return 0.0 };
    let trip_s = wall_waves::trip_s(width_m, run.natural_rad_s, run.gravity_m_s2);
    let sd = sd_s.hypot(TRIP_KNOWN * trip_s);
    let range_s = (SHARES[SHARES.len() - 1] - SHARES[0]) * trip_s;
    let off = (delay_s - trip_s) / sd;
    (range_s / (sd * std::f64::consts::TAU.sqrt())).ln() - 0.5 * off * off
}

/// Taps of the echo on either side of its delay, and their spacing in widths of the chirp.
const N_SIDE: i32 = 10;
const SPACING: f64 = 0.24;

/// The echo of the roll rate as a complex number: the integral over the delay `s` of
/// `sqrt(g/(4 pi D)) exp(i (g s^2/(4 D) - pi/4))` times the rate at `t - s`, with `td = 2 w D/g`;
/// `w phi` is the rate's other component.
fn taps<N: Number>(run: &Circumstances, p: &[N]) -> Vec<Tap<N>> {
    let (trip_s, w) = (p[2], run.natural_rad_s);
    let step_s = (trip_s * (2.0 / w)).powf(N::from(0.5)) * SPACING;
    let first_s = trip_s - step_s * f64::from(N_SIDE);
    // The phase of the chirp is w s^2/(2 td), so it turns by a growing angle from tap to tap.
    let bend = 2.0 * SPACING * SPACING;
    let mut phase = rotation(first_s * first_s / trip_s * (0.5 * w));
    let mut turn = rotation(first_s * step_s / trip_s * w + 0.5 * bend);
    let more = rotation(N::from(bend));
    let size = SPACING / std::f64::consts::PI.sqrt() * (1.0 - outrun(run)).max(0.0);
    let mut taps = Vec::new();
    for tap in -N_SIDE..=N_SIDE {
        let at = f64::from(tap) / f64::from(N_SIDE + 1);
        // A taper: frequencies far from those of the roll are not in the record.
        let weight = size * (1.0 - at * at);
        let of_roll = (p[1] * phase[0] - p[0] * phase[1]) * (w * weight);
        let of_rate = (p[0] * phase[0] + p[1] * phase[1]) * weight;
        let delay_s = first_s + step_s * f64::from(tap + N_SIDE);
        // No wave is back within half a period.
        if delay_s.value() > std::f64::consts::PI / w {
            taps.push(Tap { delay_s, of_roll, of_rate });
        }
        phase = times(phase, turn);
        turn = times(turn, more);
    }
    taps
}

fn rotation<N: Number>(angle: N) -> [N; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos, sin]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::term::tests::run;
    use crate::run::RunKind;

    #[test]
    fn an_echo_after_half_the_trip_is_none_from_the_walls() {
        // Seven metres of clear water at 6.9 rad/s: a trip of 9.8 s.
        let known = Circumstances { clear_width_m: Some(7.0), ..run(RunKind::Decay) };
        assert!(log_odds_of_trip(&known, 9.8, 0.1) > 0.5);
        assert!(log_odds_of_trip(&known, 5.4, 0.1) < -3.0);
        assert!(log_odds_of_trip(&run(RunKind::Decay), 5.4, 0.1).abs() < 1e-12);
    }
}
