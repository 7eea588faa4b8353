//! The roll before a run, which what remembers has followed until the run begins.

use super::effect::{Circumstances, Instant, Lag, MOST_LAGS};
use super::lagging::{follow, jacobian};
use super::linear::driven;
use super::number::{Sloped, slope};
use super::slopes;
use super::smoothed::{LEAST_READINGS, motion};
use super::term::Base;

/// Steps a period of roll, as a simulated decay has.
const STEPS_PER_PERIOD: f64 = 48.0;
/// What the motion at an instant is read from [periods].
const WINDOW_PERIODS: f64 = 1.5;
/// Readings of a period that are not averaged any further.
const READINGS_PER_PERIOD: f64 = 40.0;
/// Points without which nothing is followed.
const LEAST_POINTS: usize = 5;
/// States before anything has moved.
const AT_REST: [f64; MOST_LAGS] = [0.0; MOST_LAGS];

/// The motion at equal steps up to the instant at which a run begins.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lead {
    step_s: f64,
    /// Roll, roll rate, roll acceleration [rad, rad/s, rad/s2].
    motion: Vec<[f64; 3]>,
}

impl Lead {
    /// The readings [rad] up to time zero at their times [s], for a roll of some frequency [rad/s];
    /// empty where they are too few. Those after it help to tell the motion at time zero, and are
    /// none of a model that is let go then.
    pub fn new(time_s: &[f64], roll_rad: &[f64], rolling_rad_s: f64) -> Self {
        let period_s = std::f64::consts::TAU / rolling_rad_s;
        let step_s = period_s / STEPS_PER_PERIOD;
        let first_s = time_s.first().copied().unwrap_or(0.0);
        let n = (-first_s / step_s).max(0.0) as usize;
        let window_s = WINDOW_PERIODS * period_s;
        let n_near = time_s.partition_point(|t| *t < window_s);
        let of_a_period = n_near as f64 * period_s / (window_s - first_s);
        let width = ((of_a_period / READINGS_PER_PERIOD) as usize).max(1);
        let thinned = |values: &[f64]| -> Vec<f64> {
            let blocks = values[..n_near].chunks_exact(width);
            blocks.map(|block| block.iter().sum::<f64>() / width as f64).collect()
        };
        let (time_s, roll_rad) = (thinned(time_s), thinned(roll_rad));
        if n < LEAST_POINTS || time_s.len() < LEAST_READINGS {
            return Self::default();
        }
        let at_s: Vec<f64> = (0..n).map(|point| -step_s * (n - 1 - point) as f64).collect();
        Self { step_s, motion: motion(&time_s, &roll_rad, &at_s, (window_s, rolling_rad_s)) }
    }

    /// Whether anything is known of the roll before the run.
    pub fn is_known(&self) -> bool {
        !self.motion.is_empty()
    }

    /// The motion at every point.
    fn instants<'a>(&self, run: &'a Circumstances, base: &Base) -> Vec<Instant<'a>> {
        let last = self.motion.len() - 1;
        let instant = |(k, motion): (usize, &[f64; 3])| Instant {
            time_s: self.step_s * (k as f64 - last as f64),
            roll_rad: motion[0],
            rate_rad_per_s: motion[1],
            acceleration_rad_per_s2: motion[2],
            moment_n_m: 0.0,
            natural_rad_s: base.natural_rad_s,
            b1_per_s: base.b1_per_s,
            run,
        };
        self.motion.iter().enumerate().map(instant).collect()
    }

    /// Where the states of an effect stand at its end; at rest without any readings.
    pub(super) fn states(
        &self,
        lag: &Lag,
        values: &[f64],
        run: &Circumstances,
        base: &Base,
    ) -> [f64; MOST_LAGS] {
        if !self.is_known() {
            return AT_REST;
        }
        let followed = follow(lag, values, AT_REST, &self.instants(run, base), self.step_s);
        followed.last().copied().unwrap_or_default()
    }

    /// What each number of the base equation that equations name, then each parameter, does to the
    /// states at its end.
    pub(super) fn changes(
        &self,
        lag: &Lag,
        values: &[f64],
        run: &Circumstances,
        base: &Base,
    ) -> Vec<[f64; MOST_LAGS]> {
        let numbers = slope::BASE..slope::PARAMETER + values.len();
        if !self.is_known() {
            return vec![AT_REST; numbers.len()];
        }
        let instants = self.instants(run, base);
        let states = follow(lag, values, AT_REST, &instants, self.step_s);
        let rows: Vec<[Sloped; MOST_LAGS]> = instants
            .iter()
            .zip(&states)
            .map(|(i, states)| slopes::of_lag(lag, &slopes::inputs(i), values, states).0)
            .collect();
        let jacobian = jacobian(&rows[0]);
        let change = |number: usize| {
            let forcing = |k: usize| rows[k].map(|row| row.slopes[number]);
            let states = driven(&jacobian, AT_REST, forcing, rows.len(), self.step_s);
            states.last().copied().unwrap_or_default()
        };
        numbers.map(change).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::effect::Acts;
    use crate::model::effects;
    use crate::model::term::tests::run;
    use crate::run::RunKind;

    #[test]
    fn readings_at_any_rate_become_equal_steps_up_to_the_release() {
        let time_s: Vec<f64> = (0..700).map(|k| -7.0 + 0.01 * f64::from(k)).collect();
        let roll_rad: Vec<f64> = time_s.iter().map(|t| 0.2 + 0.01 * t).collect();
        let lead = Lead::new(&time_s, &roll_rad, 6.9);
        let n = lead.motion.len();
        assert!((n as f64 * lead.step_s - 7.0).abs() < 2.0 * lead.step_s, "{n} steps");
        assert!((lead.motion[n - 1][0] - 0.2).abs() < 5e-4, "{:?}", lead.motion[n - 1]);
        assert!((lead.motion[0][0] - 0.13).abs() < 5e-4, "{:?}", lead.motion[0]);
        assert_eq!(Lead::new(&[], &[], 6.9), Lead::default());
    }

    #[test]
    fn a_mode_that_gives_way_swings_as_the_rod_does_when_the_run_begins() {
        let (rod_rad_s, mode_rad_s) = (10.0_f64, 20.0_f64);
        let time_s: Vec<f64> = (0..1200).map(|k| -12.0 + 0.01 * f64::from(k)).collect();
        let roll_rad: Vec<f64> = time_s.iter().map(|t| 0.1 * (rod_rad_s * t).cos()).collect();
        let lead = Lead::new(&time_s, &roll_rad, rod_rad_s);
        let effect = effects::effect("tank.coupled_mode").unwrap();
        let Acts::Lagging(lag) = effect.acts else { panic!("it remembers") };
        let run = Circumstances { rolling_rad_s: rod_rad_s, ..run(RunKind::Forced) };
        let base = Base { natural_rad_s: 6.9, b1_per_s: 0.2, b3_s: 0.0, log_scale: 0.0 };
        let [swing, _] = lead.states(&lag, &[0.05, mode_rad_s], &run, &base);
        let steady = 0.1 * rod_rad_s.powi(2) / (mode_rad_s.powi(2) - rod_rad_s.powi(2));
        assert!((swing / steady - 1.0).abs() < 0.01, "{swing} and {steady} at once");
    }
}
