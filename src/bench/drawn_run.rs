//! A decay drawn from what tanks see: hull, Froude number, amplitude, noise.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::run::{Run, RunEnd, RunKind, Series, Timing};
use crate::tank::FreeRoll;

/// What the decays of one campaign have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnCampaign {
    /// Natural frequency [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Linear damping at rest [1/s].
    pub b0_per_s: f64,
    /// Speed coefficient [-].
    pub kappa: f64,
    /// Run-to-run standard deviation of the linear damping over that at rest [-].
    pub scatter: f64,
    /// Equivalent damping that the cubic part adds at the initial amplitude, over `b0` [-].
    pub cubic_share: f64,
    /// Standard deviation of the roll noise [rad].
    pub noise_rad: f64,
    /// Sample rate [Hz].
    pub rate_hz: f64,
}

/// Froude numbers of a campaign [-].
pub const FROUDE: [f64; 5] = [0.0, 0.1, 0.2, 0.3, 0.4];

fn between(rng: &mut impl Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.random::<f64>()
}

fn log_between(rng: &mut impl Rng, low: f64, high: f64) -> f64 {
    between(rng, low.ln(), high.ln()).exp()
}

impl DrawnCampaign {
    /// Draws a campaign.
    pub fn draw(rng: &mut impl Rng) -> Self {
        let natural_frequency_rad_s = between(rng, 2.0, 8.0);
        let ratio = log_between(rng, 0.01, 0.06);
        Self {
            natural_frequency_rad_s,
            b0_per_s: 2.0 * ratio * natural_frequency_rad_s,
            kappa: between(rng, 2.0, 12.0),
            scatter: log_between(rng, 0.03, 0.25),
            cubic_share: between(rng, 0.05, 1.0),
            noise_rad: log_between(rng, 0.01, 0.1).to_radians(),
            rate_hz: [50.0, 100.0, 200.0][rng.random_range(0..3)],
        }
    }

    /// Linear damping of a run at a Froude number [1/s].
    fn b1_per_s(&self, froude: f64, rng: &mut impl Rng) -> f64 {
        // A scatter that leaves no damping is no tank's.
        loop {
            let stray: f64 = rng.sample(StandardNormal);
            let share = 1.0 + self.kappa * froude * froude + self.scatter * stray;
            if share > 0.2 {
                return self.b0_per_s * share;
            }
        }
    }
}

/// One decay with its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnRun {
    /// Froude number [-].
    pub froude: f64,
    /// The true motion.
    pub truth: FreeRoll,
    /// Amplitude at the start [rad].
    pub amplitude_rad: f64,
    /// What the instruments saw of it.
    pub run: Run,
    /// True roll [rad] and rate [rad/s] every half sample period.
    half_steps: Vec<(f64, f64)>,
}

/// A record ends where the roll has fallen to this share of its start, at the latest.
const FALLEN_TO: f64 = 1.0 / 15.0;
/// Or after this many periods.
const N_PERIODS: f64 = 30.0;

impl DrawnRun {
    /// Draws a run of a campaign at a Froude number.
    pub fn draw(campaign: &DrawnCampaign, froude: f64, rng: &mut impl Rng) -> Self {
        let w = campaign.natural_frequency_rad_s;
        let amplitude_rad = between(rng, 5.0, 20.0).to_radians();
        let phase = between(rng, 0.0, std::f64::consts::TAU);
        let zero_rad = 0.5_f64.to_radians() * rng.sample::<f64, _>(StandardNormal);
        let truth = FreeRoll {
            natural_frequency_rad_s: w,
            b1_per_s: campaign.b1_per_s(froude, rng),
            b3_s: campaign.cubic_share * campaign.b0_per_s / (0.75 * (w * amplitude_rad).powi(2)),
            initial_roll_rad: amplitude_rad * phase.cos(),
            initial_roll_rate_rad_per_s: -w * amplitude_rad * phase.sin(),
        };
        let period_s = std::f64::consts::TAU / w;
        let longest = (N_PERIODS * period_s * campaign.rate_hz) as usize;
        let half_steps = truth.motion(0.5 / campaign.rate_hz, 2 * longest);
        let size = |state: &(f64, f64)| state.0.hypot(state.1 / w);
        let smallest = (FALLEN_TO * amplitude_rad).max(3.0 * campaign.noise_rad);
        let fallen = half_steps.iter().position(|state| size(state) < smallest);
        let n_samples = fallen.map_or(longest, |half| half / 2).max(30);
        let time_s: Vec<f64> = (0..n_samples).map(|i| i as f64 / campaign.rate_hz).collect();
        let value = (0..n_samples)
            .map(|i| {
                let noise: f64 = rng.sample(StandardNormal);
                half_steps[2 * i].0 + zero_rad + campaign.noise_rad * noise
            })
            .collect();
        let run = Run {
            kind: RunKind::Decay,
            start_s: 0.0,
            end_s: time_s[n_samples - 1],
            end: RunEnd::LostInNoise,
            speed_m_s: None,
            roll: Series { time_s, value },
            drive: Series::default(),
            speed: Series::default(),
            lead: Series::default(),
            still: None,
            excitation_rad_s: None,
            timing: Timing::default(),
        };
        Self { froude, truth, amplitude_rad, run, half_steps }
    }

    /// The true moment `U` [rad/s2] at a time [s] that is a multiple of half a sample period.
    pub fn moment_per_s2(&self, time_s: f64) -> f64 {
        let period_s = self.run.roll.time_s[1];
        let at = (2.0 * time_s / period_s).round() as usize;
        let rate = self.half_steps[at.min(self.half_steps.len() - 1)].1;
        -self.truth.b1_per_s * rate - self.truth.b3_s * rate.powi(3)
    }

    /// The true equivalent damping [1/s] at an amplitude [rad].
    pub fn equivalent_per_s(&self, amplitude_rad: f64) -> f64 {
        let rate = self.truth.natural_frequency_rad_s * amplitude_rad;
        self.truth.b1_per_s + 0.75 * rate * rate * self.truth.b3_s
    }
}
