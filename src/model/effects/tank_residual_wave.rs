//! Waves of an earlier run still press on the model.

use crate::model::effect::{
    Acts, Circumstances, Effect, Instant, Law, Layer, Parameter, Scope, any_run, each,
};
use crate::model::number::Number;
use crate::roll::cross_modes;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "tank.residual_wave",
    layer: Layer::Tank,
    equation: "a cos(v t) + b sin(v t)",
    strengths: &[
        Parameter::new("a", "rad/s2", 0.008, [-0.1, 0.1]),
        Parameter::new("b", "rad/s2", 0.008, [-0.1, 0.1]),
    ],
    shapes: &[Parameter::new("v", "rad/s", 0.12, [1.0, 20.0]).held_to(log_odds_of_mode)],
    nodes: |run| {
        let shares = [0.7, 0.8, 0.86, 0.92, 0.98, 1.04, 1.1, 1.2];
        each(&shares.map(|share| share * run.natural_rad_s))
    },
    scope: Scope::Run,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "ITTC 7.5-02-07-02.1: waiting time",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    let (sin, cos) = (p[2] * i.time_s).sin_cos();
    p[0] * cos + p[1] * sin
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
    use crate::model::term::tests::run;
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
}
