//! How the damping of decays and forced runs follows what is wrong with gains, clock and GM.
//!
//! A decay has its frequency and its rates from the roll alone: a gain changes `b3` by its square,
//! and `GM` comes in with the inertia `K/wn^2` alone. A forced run has `B` from the work of the
//! moment and `I = K/w^2 - |M| cos(eps)/(w^2 A)`: what is wrong with `K`, or with the moment over
//! the roll, is `(wn/w)^2` times as wrong in `b = B/I`.

use super::repeats::Repeats;
use crate::results::IdentifiedRun;
use crate::roll::damping::cubic_weight;
use crate::run::RunKind;

/// Change of one number per unit of relative error.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ByGain {
    pub(super) roll_gain: f64,
    pub(super) force_gain: f64,
    pub(super) gm: f64,
}

/// The slopes of the mean `b_eq` of some runs [1/s].
pub(super) struct Slopes {
    /// Mean frequency at which the model rolls [rad/s].
    pub(super) frequency_rad_s: f64,
    /// Of `b_eq`.
    pub(super) damping: ByGain,
    /// Of the damping moment, as a part of `b_eq` that is as large as its part of the moment.
    pub(super) moment: ByGain,
    amplitude_rad: f64,
    kind: RunKind,
}

impl Slopes {
    pub(super) fn of(kind: RunKind, runs: &[&IdentifiedRun], repeats: &Repeats) -> Self {
        let mean = |of: &dyn Fn(&IdentifiedRun) -> f64| {
            runs.iter().map(|run| of(run)).sum::<f64>() / runs.len() as f64
        };
        let b = repeats.mean_per_s;
        let nonlinear = 2.0 * (b - mean(&|run| run.identification.damping.b1_per_s.mean));
        let frequency_rad_s = mean(&|run| run.identification.rolling_frequency_rad_s());
        let (damping, moment) = match kind {
            RunKind::Decay => (
                ByGain { roll_gain: nonlinear, ..ByGain::default() },
                ByGain { roll_gain: nonlinear, gm: b, ..ByGain::default() },
            ),
            RunKind::Forced => {
                let natural = mean(&|run| run.identification.natural_frequency_rad_s.mean);
                let by_inertia = (natural / frequency_rad_s).powi(2) * b;
                (
                    ByGain {
                        roll_gain: by_inertia + nonlinear,
                        force_gain: by_inertia,
                        gm: by_inertia,
                    },
                    ByGain { roll_gain: b + nonlinear, force_gain: b, gm: 0.0 },
                )
            }
        };
        let amplitude_rad = repeats.amplitude_deg.to_radians();
        Self { frequency_rad_s, damping, moment, amplitude_rad, kind }
    }

    /// What the time between roll and moment leaves unsure [1/s], where every run states it.
    pub(super) fn skew_per_s(&self, runs: &[&IdentifiedRun]) -> Option<f64> {
        if self.kind == RunKind::Decay {
            return Some(0.0);
        }
        let weight = cubic_weight(self.frequency_rad_s, self.amplitude_rad);
        let of = |run: &&IdentifiedRun| Some(run.identification.skew?.damping_sd_per_s(weight));
        let all: Vec<f64> = runs.iter().map(of).collect::<Option<_>>()?;
        Some(all.iter().sum::<f64>() / all.len() as f64)
    }
}
