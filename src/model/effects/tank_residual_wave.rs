//! Waves of an earlier run still press on the model.

use crate::model::effect::{
    Acts, Circumstances, Effect, Instant, Law, Layer, Parameter, Scope, any_run,
};
use crate::model::number::Number;
use crate::roll::cross_modes;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.residual_wave",
    layer: Layer::Tank,
    equation: "(a cos(v t) + b sin(v t)) exp(-d t)",
    strengths: &[
        Parameter::new("a", "rad/s2", 0.008, [-0.1, 0.1]),
        Parameter::new("b", "rad/s2", 0.008, [-0.1, 0.1]),
    ],
    shapes: &[
        Parameter::new("v", "rad/s", SOUGHT_RAD_S, [1.0, 20.0]).held_to(log_odds_of_mode),
        Parameter::new("d", "1/s", CALMS_PER_S, [0.0, 0.1]),
    ],
    nodes: |run| standing(run).into_iter().map(|v| vec![v, CALMS_PER_S]).collect(),
    scope: Scope::Run,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-02.1: waiting time",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let (sin, cos) = (p[2] * i.time_s).sin_cos();
    let wave = p[0] * cos + p[1] * sin;
    if outlasts_the_roll(i.run) { wave } else { wave * (-(p[3] * i.time_s)).exp() }
}

/// Whether waves are left as long as the model rolls, or longer. One that died away as such a roll
/// does would be any want of the roll's own decay, so these are taken to last.
fn outlasts_the_roll(run: &Circumstances) -> bool {
    0.5 * run.b1_per_s < OUTLASTED * CALMS_PER_S
}

/// How far about a mode a wave's frequency is sought [rad/s]: modes lie some tenths apart, and a
/// wider search took up the damping that the runs had besides.
const SOUGHT_RAD_S: f64 = 0.04;
/// How many times faster than a tank calms down a roll must die away to be told from its waves. By
/// judgement: KVLCC2 rolls on as long as a tank does, the seed model twenty times less.
const OUTLASTED: f64 = 3.0;

/// Rate at which a tank calms down, and how well that is known [1/s]: waves are left for minutes,
/// which crews wait for (ITTC 7.5-02-07-02.1). By judgement.
const CALMS_PER_S: f64 = 0.01;

/// Shares of the natural frequency between which a wave rolls the model.
const ROLLS: [f64; 2] = [0.7, 1.2];
/// Frequencies tried in a tank whose width is not known: no farther apart than a fit finds its way.
const N_TRIED: usize = 16;

/// Frequencies [rad/s] of the waves that may be left.
fn standing(run: &Circumstances) -> Vec<f64> {
    let [low, high] = ROLLS.map(|share| share * run.natural_rad_s);
    let modes = run.section.iter().flat_map(|of| cross_modes::all(of, run.gravity_m_s2));
    let modes: Vec<f64> = modes.filter(|mode| (low..high).contains(mode)).collect();
    if !modes.is_empty() {
        return modes;
    }
    let step = (high - low) / (N_TRIED - 1) as f64;
    (0..N_TRIED).map(|k| low + step * k as f64).collect()
}

/// Share to which a tank's modes follow from its width and depth.
const MODES_KNOWN: f64 = 0.005;

/// Logarithm of the odds that a wave of `frequency_rad_s` [rad/s], known to `sd_rad_s` [rad/s], is
/// a standing wave of the tank: what is left of an earlier run, against any frequency as likely.
fn log_odds_of_mode(run: &Circumstances, frequency_rad_s: f64, sd_rad_s: f64) -> f64 {
    let Some(section) = run.section else { return 0.0 };
    let (mode, spacing) = cross_modes::nearest(frequency_rad_s, &section, run.gravity_m_s2);
    let sd = sd_rad_s.hypot(MODES_KNOWN * mode);
    let off = (frequency_rad_s - mode) / sd;
    (spacing / (sd * std::f64::consts::TAU.sqrt())).ln() - 0.5 * off * off
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::term::tests::{run, swing};
    use crate::roll::cross_modes::Section;
    use crate::run::RunKind;

    #[test]
    fn a_wave_off_the_modes_of_the_tank_is_none_that_was_left() {
        let section = Some(Section { width_m: 10.0, depth_m: Some(5.0) });
        let known = Circumstances { section, ..run(RunKind::Decay) };
        assert!(log_odds_of_mode(&known, 6.80, 0.02) > 1.0);
        assert!(log_odds_of_mode(&known, 6.95, 0.02) < -3.0);
        // Nothing is held against a frequency that is hardly known, nor in a tank of any width.
        assert!(log_odds_of_mode(&known, 6.95, 1.0).abs() < 2.0);
        let unknown = Circumstances { section: None, ..known };
        assert!(log_odds_of_mode(&unknown, 6.95, 0.02).abs() < 1e-12);
    }

    #[test]
    fn a_wave_that_lasts_as_long_as_the_roll_does_not_die_away_as_that_does() {
        let after_a_minute = |b1_per_s| {
            let run = Circumstances { b1_per_s, ..run(RunKind::Decay) };
            let instant = swing(&run, 2, 60.0)[1];
            law(&instant, &[1.0, 0.0, 0.0, 0.01])
        };
        assert!((after_a_minute(0.4) - f64::exp(-0.6)).abs() < 1e-12);
        assert!((after_a_minute(0.02) - 1.0).abs() < 1e-12);
    }
}
