//! The measured moment of a forced run, and the roll that it makes.

use super::response::SteadyResponse;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{DampingFit, MomentHistory, Resimulation};
use crate::inverse::record::Record;
use crate::inverse::state_space::history::Reference;
use crate::inverse::state_space::posterior::StatePosterior;
use crate::run::Run;

/// The measured moment per unit inertia, ready to drive an oscillator.
pub(in crate::inverse) struct Drive {
    /// Instant of time zero [s].
    origin_s: f64,
    time_s: Vec<f64>,
    moment_per_s2: Vec<f64>,
}

impl Drive {
    pub(in crate::inverse) fn new(
        response: &SteadyResponse,
        record: &Record,
        run: &Run,
        inertia_kg_m2: f64,
    ) -> Self {
        let shift_s = record.origin_s - run.start_s;
        Self {
            origin_s: record.origin_s,
            time_s: response.moment_time_s.iter().map(|t| t - shift_s).collect(),
            moment_per_s2: response
                .moment_n_m
                .iter()
                .map(|m| (m - response.moment.mean) / inertia_kg_m2)
                .collect(),
        }
    }

    /// Moment per unit inertia [rad/s2] at a time [s] from the origin.
    pub(in crate::inverse) fn at(&self, time_s: f64) -> f64 {
        let after = self.time_s.partition_point(|t| *t < time_s).clamp(1, self.time_s.len() - 1);
        let (before_s, after_s) = (self.time_s[after - 1], self.time_s[after]);
        let share = ((time_s - before_s) / (after_s - before_s)).clamp(0.0, 1.0);
        let (before, after) = (self.moment_per_s2[after - 1], self.moment_per_s2[after]);
        before + share * (after - before)
    }

    /// Instant of time zero [s] on the recording's time base.
    pub(in crate::inverse) fn origin_s(&self) -> f64 {
        self.origin_s
    }

    /// Roll and scaled rate of the undamped oscillator from rest under the moment, which is
    /// straight between its samples.
    pub(in crate::inverse) fn response(
        &self,
        times_s: &[f64],
        natural_rad_s: f64,
    ) -> Vec<[f64; 2]> {
        let w = natural_rad_s;
        let (mut now_s, mut state) = (0.0, [0.0, 0.0]);
        let mut next = self.time_s.partition_point(|t| *t <= 0.0);
        let mut out = Vec::with_capacity(times_s.len());
        for &until_s in times_s {
            while now_s < until_s {
                let stop_s = self.time_s.get(next).map_or(until_s, |t| t.min(until_s));
                let span_s = stop_s - now_s;
                let (from, to) = (self.at(now_s), self.at(stop_s));
                // Particular solution of a straight line: (m - slope corrections) / w^2.
                let slope = if span_s > 0.0 { (to - from) / span_s } else { 0.0 };
                let (sin, cos) = (w * span_s).sin_cos();
                let roll = state[0] - from / (w * w);
                let rate = state[1] - slope / w.powi(3);
                state = [
                    roll * cos + rate * sin + to / (w * w),
                    rate * cos - roll * sin + slope / w.powi(3),
                ];
                now_s = stop_s;
                if self.time_s.get(next).is_some_and(|t| *t <= now_s) {
                    next += 1;
                }
            }
            out.push(state);
        }
        out
    }

    /// Intensity of the moment's noise in scaled time, in units of the roll noise.
    pub(in crate::inverse) fn noise_intensity(
        &self,
        response: &SteadyResponse,
        natural_rad_s: f64,
    ) -> f64 {
        let n = self.time_s.len();
        let step_s = (self.time_s[n - 1] - self.time_s[0]) / (n - 1) as f64;
        let noise = response.moment_noise_n_m / response.inertia_kg_m2.mean;
        noise * step_s.sqrt() / (natural_rad_s.powf(1.5) * response.roll.noise_sd)
    }

    /// The moment history: the posterior of what the measured moment leaves, with the motion that
    /// the moment made put back.
    pub(in crate::inverse) fn history(
        &self,
        record: &Record,
        states: &StatePosterior,
        driven: &[[f64; 2]],
        reference: &Reference,
    ) -> MomentHistory {
        let w = reference.natural_frequency_rad_s;
        let alone = Reference {
            natural_frequency_sd_rad_s: 0.0,
            zero_rad: 0.0,
            zero_sd_rad: 0.0,
            natural_frequency_rad_s: w,
        };
        let mut history = MomentHistory::of_decay(record, states, &alone);
        // The moment's constant is the restoring of the mean roll, which is no damping.
        let n = history.mean_per_s2.len() as f64;
        let mean = history.mean_per_s2.iter().sum::<f64>() / n;
        for (i, driven) in driven.iter().enumerate() {
            history.roll_rad[i] += driven[0] - reference.zero_rad;
            history.roll_rate_rad_per_s[i] += w * driven[1];
            history.mean_per_s2[i] -= mean;
            // With K known, an error of w is one of the inertia by which the moment is divided.
            let share = 2.0 * reference.natural_frequency_sd_rad_s / w;
            let sd = history.sd_per_s2[i].hypot(share * self.at(record.time_s[i]));
            let band = Estimate::normal(history.mean_per_s2[i], sd);
            history.sd_per_s2[i] = sd;
            history.lo95_per_s2[i] = band.lo95;
            history.hi95_per_s2[i] = band.hi95;
        }
        history
    }

    /// The run simulated under its measured moment with the fitted law (Fig. 17c).
    pub(in crate::inverse) fn resimulation(
        &self,
        record: &Record,
        damping: &DampingFit,
        reference: &Reference,
        start: (f64, f64),
    ) -> Resimulation {
        let (natural_rad_s, zero_rad) = (reference.natural_frequency_rad_s, reference.zero_rad);
        let (b1, b3) = (damping.b1_per_s.mean, damping.b3_s.mean);
        let acceleration = |time_s: f64, roll: f64, rate: f64| {
            self.at(time_s) - b1 * rate - b3 * rate.powi(3) - natural_rad_s.powi(2) * roll
        };
        let (mut roll, mut rate) = start;
        let mut simulated_rad = vec![roll + zero_rad];
        for pair in record.time_s.windows(2) {
            let h = pair[1] - pair[0];
            let (k1, l1) = (rate, acceleration(pair[0], roll, rate));
            let half = pair[0] + 0.5 * h;
            let (k2, l2) =
                (rate + 0.5 * h * l1, acceleration(half, roll + 0.5 * h * k1, rate + 0.5 * h * l1));
            let (k3, l3) =
                (rate + 0.5 * h * l2, acceleration(half, roll + 0.5 * h * k2, rate + 0.5 * h * l2));
            let (k4, l4) = (rate + h * l3, acceleration(pair[1], roll + h * k3, rate + h * l3));
            roll += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            rate += h / 6.0 * (l1 + 2.0 * (l2 + l3) + l4);
            simulated_rad.push(roll + zero_rad);
        }
        record.resimulation(simulated_rad)
    }
}
