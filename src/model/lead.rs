//! The roll before a run, which what remembers has followed until the run begins.

use super::effect::{Circumstances, Instant, Lag, MOST_LAGS};
use super::lagging::{follow, jacobian};
use super::linear::driven;
use super::number::{Sloped, slope};
use super::slopes;
use super::term::Base;

/// Steps a period of roll, as a simulated decay has.
const STEPS_PER_PERIOD: f64 = 48.0;
/// States before anything has moved.
const AT_REST: [f64; MOST_LAGS] = [0.0; MOST_LAGS];
/// Points that a derivative at either end needs.
const LEAST_POINTS: usize = 5;

/// Roll at equal steps up to the instant at which a run begins.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lead {
    step_s: f64,
    roll_rad: Vec<f64>,
}

impl Lead {
    /// The readings [rad] up to time zero at their times [s], for a roll of some frequency [rad/s];
    /// empty where they are too few.
    pub fn new(time_s: &[f64], roll_rad: &[f64], rolling_rad_s: f64) -> Self {
        let step_s = std::f64::consts::TAU / (STEPS_PER_PERIOD * rolling_rad_s);
        let first_s = time_s.first().copied().unwrap_or(0.0);
        let n = (-first_s / step_s).max(0.0) as usize;
        if n < LEAST_POINTS || time_s.len() < LEAST_POINTS {
            return Self::default();
        }
        let at = |point: usize| {
            let middle_s = -step_s * (n - 1 - point) as f64;
            let place = |t: f64| time_s.partition_point(|time_s| *time_s < t);
            let (from, to) = (place(middle_s - 0.5 * step_s), place(middle_s + 0.5 * step_s));
            // A step without a reading takes the one before it.
            let to = to.clamp(1, time_s.len());
            let readings = &roll_rad[from.min(to - 1)..to];
            readings.iter().sum::<f64>() / readings.len() as f64
        };
        Self { step_s, roll_rad: (0..n).map(at).collect() }
    }

    /// Whether anything is known of the roll before the run.
    pub fn is_known(&self) -> bool {
        !self.roll_rad.is_empty()
    }

    /// The motion at every point.
    fn instants<'a>(&self, run: &'a Circumstances, base: &Base) -> Vec<Instant<'a>> {
        let last = self.roll_rad.len() - 1;
        let rate = |k: usize| {
            let (from, to) = (k.saturating_sub(1), (k + 1).min(last));
            (self.roll_rad[to] - self.roll_rad[from]) / (self.step_s * (to - from) as f64)
        };
        let acceleration = |k: usize| {
            let middle = k.clamp(1, last - 1);
            let [before, here, after] = [middle - 1, middle, middle + 1].map(|k| self.roll_rad[k]);
            (before - 2.0 * here + after) / self.step_s.powi(2)
        };
        let instant = |k: usize| Instant {
            time_s: self.step_s * (k as f64 - last as f64),
            roll_rad: self.roll_rad[k],
            rate_rad_per_s: rate(k),
            acceleration_rad_per_s2: acceleration(k),
            moment_n_m: 0.0,
            natural_rad_s: base.natural_rad_s,
            b1_per_s: base.b1_per_s,
            run,
        };
        (0..=last).map(instant).collect()
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
        let n = lead.roll_rad.len();
        assert!((n as f64 * lead.step_s - 7.0).abs() < 2.0 * lead.step_s, "{n} steps");
        assert!((lead.roll_rad[n - 1] - 0.2).abs() < 2e-4, "{}", lead.roll_rad[n - 1]);
        assert!((lead.roll_rad[0] - 0.13).abs() < 5e-4, "{}", lead.roll_rad[0]);
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
        assert!((swing / steady - 1.0).abs() < 0.06, "{swing} and {steady} at once");
    }
}
