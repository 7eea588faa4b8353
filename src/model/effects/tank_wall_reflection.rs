//! Waves that the model made come back from the tank walls, the long ones first.

use crate::model::echo::{Tap, Taps};
use crate::model::effect::{Acts, Circumstances, Effect, Layer, Parameter, Scope};
use crate::model::number::Number;
use crate::roll::wall_waves;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.wall_reflection",
    layer: Layer::Tank,
    equation: "(1 - w V/(0.305 g)) (r1 Re E + r2 Im E), E = phi' through w^q exp(-i w^2 D/g)",
    strengths: &[
        Parameter::new("r1", "1/s", 0.1, [-1.0, 1.0]),
        Parameter::new("r2", "1/s", 0.1, [-1.0, 1.0]),
    ],
    shapes: &[
        Parameter::new("td", "s", 1.0, [3.0, 60.0]).held_to(log_odds_of_trip),
        Parameter::new("q", "-", 1.0, [-1.0, 5.0]),
    ],
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

/// Power of the frequency to which a roll makes waves, which is fitted from here.
const POWER: f64 = 1.0;

/// Round trips at the group velocity `g/(2 w)` in deep water, as far apart as an echo is wide.
fn delays(run: &Circumstances) -> Vec<Vec<f64>> {
    let delays_s = match run.clear_width_m {
        Some(width_m) => {
            let trip_s = wall_waves::trip_s(width_m, run.natural_rad_s, run.gravity_m_s2);
            SHARES.map(|share| share * trip_s).to_vec()
        }
        None => vec![8.0, 10.0, 12.0, 14.0, 17.0, 20.0],
    };
    delays_s.into_iter().map(|delay_s| vec![delay_s, POWER]).collect()
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

/// Shares of the trip from which and until which the echo is heard, and those between which it is
/// heard in full: frequencies far from those of the roll are not in the record. By trial on
/// simulated walls; from 0.4 to 2 more was left, for one power does not hold so far from the roll's
/// frequency.
const HEARD: [f64; 2] = [0.45, 1.65];
const HEARD_IN_FULL: [f64; 2] = [0.7, 1.3];

/// The echo of the roll rate as a complex number, one tap every half period: the integral over the
/// delay `s` of `sqrt(g/(4 pi D)) (s/td)^q exp(i (g s^2/(4 D) - pi/4))` times the rate at `t - s`,
/// with `td = 2 w D/g`: what arrives after `s` has the frequency `w s/td`.
///
/// The rate's other component is `(w phi - phi''/w)/2`, to the second order about `w`.
fn taps<N: Number>(run: &Circumstances, p: &[N]) -> Vec<Tap<N>> {
    let (trip_s, w) = (p[2], run.natural_rad_s);
    let step_s = std::f64::consts::PI / w;
    let reach = HEARD.map(|share| share * trip_s.value() / step_s);
    // No wave is back within half a period.
    let places = (reach[0].ceil() as usize).max(2)..=reach[1].floor() as usize;
    let size = step_s * (w / std::f64::consts::TAU).sqrt() * (1.0 - outrun(run)).max(0.0);
    let size = trip_s.powf(N::from(-0.5)) * size;
    let tap = |half_periods: usize| {
        let delay_s = step_s * half_periods as f64;
        let share = trip_s.powf(N::from(-1.0)) * delay_s;
        let (sin, cos) = (share * (0.5 * w * delay_s)).sin_cos();
        let weight = size * share.powf(p[3]) * window(share);
        let of_other = (p[1] * cos - p[0] * sin) * weight;
        let of_roll = of_other * (0.5 * w);
        let of_rate = (p[0] * cos + p[1] * sin) * weight;
        Tap { half_periods, of_roll, of_rate, of_acceleration: of_other * (-0.5 / w) }
    };
    places.map(tap).collect()
}

/// From nothing to all and back, smoothly.
fn window<N: Number>(share: N) -> N {
    let at = share.value();
    let (edge, full) =
        if at < 1.0 { (HEARD[0], HEARD_IN_FULL[0]) } else { (HEARD[1], HEARD_IN_FULL[1]) };
    if (HEARD_IN_FULL[0]..=HEARD_IN_FULL[1]).contains(&at) {
        return N::from(1.0);
    }
    let (sin, _) = ((share - edge) * (std::f64::consts::FRAC_PI_2 / (full - edge))).sin_cos();
    sin * sin
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
