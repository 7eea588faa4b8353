//! The measured exciting moment as a course in time, with its noise.

use crate::roll::exciting_moment::Exciter;
use crate::run::{Run, Series};

/// A moment with a cubic through its samples and the slopes of their neighbours.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moment {
    time_s: Vec<f64>,
    values_n_m: Vec<f64>,
}

impl Moment {
    /// A moment [N m] at times [s] that rise.
    pub(super) fn new(time_s: Vec<f64>, values_n_m: Vec<f64>) -> Self {
        Self { time_s, values_n_m }
    }

    /// The moment of a run, time from `origin_s` [s]: a recorded one, or a force through its arm.
    ///
    /// # Errors
    /// When the run has hardly any drive.
    pub(super) fn of(run: &Run, exciter: Option<&Exciter>, origin_s: f64) -> Result<Self, String> {
        let drive = &run.drive;
        if drive.time_s.len() < 30 {
            return Err("a forced run needs its measured force or moment".into());
        }
        let zero = run.still.and_then(|still| still.force).unwrap_or(0.0);
        let values_n_m = drive
            .time_s
            .iter()
            .zip(&drive.value)
            .map(|(&time_s, &value)| match exciter {
                Some(exciter) => exciter.moment_n_m(value - zero, at(&run.roll, time_s)),
                None => value - zero,
            })
            .collect();
        Ok(Self::new(drive.time_s.iter().map(|t| t - origin_s).collect(), values_n_m))
    }

    /// The moment at a time; beyond the ends the last value stands.
    pub(super) fn at_n_m(&self, time_s: f64) -> f64 {
        let (t, v) = (&self.time_s, &self.values_n_m);
        let after = t.partition_point(|t| *t < time_s).clamp(1, t.len() - 1);
        let (before, width_s) = (after - 1, t[after] - t[after - 1]);
        if after < 2 || after + 1 == t.len() || width_s <= 0.0 {
            return interpolated(t, v, time_s);
        }
        // A straight line would cut the crests of a moment by a thousandth.
        let slope = |i: usize| width_s * (v[i + 1] - v[i - 1]) / (t[i + 1] - t[i - 1]);
        let (leaving, arriving, rise) = (slope(before), slope(after), v[after] - v[before]);
        let share = ((time_s - t[before]) / width_s).clamp(0.0, 1.0);
        let (bend, twist) =
            (3.0 * rise - 2.0 * leaving - arriving, leaving + arriving - 2.0 * rise);
        v[before] + share * (leaving + share * (bend + share * twist))
    }

    /// Square root of the noise's variance times the sample period [N m s^(1/2)].
    pub(super) fn noise_intensity(&self) -> f64 {
        let n = self.time_s.len();
        let step_s = (self.time_s[n - 1] - self.time_s[0]) / (n - 1) as f64;
        rough_noise(&self.values_n_m) * step_s.sqrt()
    }
}

/// Standard deviation of the noise of a channel, from what a cubic through neighbours leaves.
///
/// Fourth differences of a smooth course are nil; those of a white noise have 70 times its
/// variance.
pub(super) fn rough_noise(values: &[f64]) -> f64 {
    let difference = |v: &[f64]| v[0] - 4.0 * v[1] + 6.0 * v[2] - 4.0 * v[3] + v[4];
    let square: f64 = values.windows(5).map(|v| difference(v).powi(2)).sum();
    (square / 70.0 / values.len().saturating_sub(4).max(1) as f64).sqrt()
}

fn at(series: &Series, time_s: f64) -> f64 {
    interpolated(&series.time_s, &series.value, time_s)
}

fn interpolated(time_s: &[f64], values: &[f64], at_s: f64) -> f64 {
    let after = time_s.partition_point(|t| *t < at_s).clamp(1, time_s.len() - 1);
    let width_s = time_s[after] - time_s[after - 1];
    let share = if width_s > 0.0 { (at_s - time_s[after - 1]) / width_s } else { 1.0 };
    values[after - 1] + share.clamp(0.0, 1.0) * (values[after] - values[after - 1])
}
