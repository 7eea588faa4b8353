//! Simulated roll tests for the paper's sampler.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rolltank::inverse::paper::{Convolution, Hyperpriors, PriorPower};

/// One roll test and the prior it is read with.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    pub(crate) natural_frequency_rad_s: f64,
    pub(crate) b1_per_s: f64,
    pub(crate) b3_s: f64,
    pub(crate) amplitude_rad: f64,
    pub(crate) noise_rad: f64,
    pub(crate) n: usize,
    pub(crate) step_s: f64,
    /// Amplitude [rad/s2] and frequency [rad/s] of the exciting moment over the inertia.
    pub(crate) forcing: (f64, f64),
    pub(crate) hyper: Hyperpriors,
    pub(crate) power: PriorPower,
}

/// A decay of the bare hull read as the paper reads it.
pub(crate) const BARE_HULL_AS_PRINTED: Case = Case {
    natural_frequency_rad_s: 6.905,
    b1_per_s: 0.4203,
    b3_s: 0.1219,
    amplitude_rad: 0.17,
    noise_rad: 0.001,
    n: 100,
    step_s: 0.08,
    forcing: (0.0, 0.0),
    hyper: Hyperpriors::PAPER,
    power: PriorPower::Printed,
};

/// A larger, faster dying decay with bilge keels, smaller hyperpriors, rank as it should be.
pub(crate) const BILGE_KEELS: Case = Case {
    natural_frequency_rad_s: 6.136,
    b1_per_s: 1.3262,
    b3_s: 0.6725,
    amplitude_rad: 0.35,
    noise_rad: 0.005,
    n: 120,
    step_s: 0.05,
    forcing: (0.0, 0.0),
    hyper: Hyperpriors { alpha1: 1e-3, beta1: 1e-3, alpha2: 1e-3, beta2: 1e-3 },
    power: PriorPower::Rank,
};

/// Forced rolling below resonance, hyperpriors too small to set a scale.
pub(crate) const FORCED_SCALE_FREE: Case = Case {
    natural_frequency_rad_s: 6.136,
    b1_per_s: 0.8,
    b3_s: 0.3,
    amplitude_rad: 0.05,
    noise_rad: 0.002,
    n: 80,
    step_s: 0.1,
    forcing: (1.5, 5.12),
    hyper: Hyperpriors { alpha1: 1e-6, beta1: 1e-9, alpha2: 1e-6, beta2: 1e-9 },
    power: PriorPower::Rank,
};

impl Case {
    /// The observable of a simulated record, its noise drawn from `seed`.
    pub(crate) fn observable(&self, seed: u64) -> (Convolution, Vec<f64>) {
        let w = self.natural_frequency_rad_s;
        let convolution =
            Convolution::new(self.n, self.step_s, w).expect("the case resolves its frequency");
        let moment = |t: f64| self.forcing.0 * (self.forcing.1 * t).cos();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let roll: Vec<f64> = self
            .simulate(moment)
            .into_iter()
            .map(|phi| phi + self.noise_rad * rng.sample::<f64, _>(StandardNormal))
            .collect();
        let moments: Vec<f64> = (0..self.n).map(|i| moment(self.step_s * i as f64)).collect();
        let g = convolution.observable(&roll, self.amplitude_rad, 0.0, Some(&moments));
        (convolution, g)
    }

    /// Roll [rad] by the classical Runge-Kutta method, forty steps to a sample.
    fn simulate(&self, moment: impl Fn(f64) -> f64) -> Vec<f64> {
        const N_STEPS: usize = 40;
        let h = self.step_s / N_STEPS as f64;
        let slope = |t: f64, (phi, rate): (f64, f64)| {
            let damping = self.b1_per_s * rate + self.b3_s * rate.powi(3);
            (rate, moment(t) - damping - self.natural_frequency_rad_s.powi(2) * phi)
        };
        let along = |(a, b): (f64, f64), (c, d): (f64, f64), h: f64| (a + h * c, b + h * d);
        let mut state = (self.amplitude_rad, 0.0);
        (0..self.n)
            .map(|i| {
                let sampled = state.0;
                for k in 0..N_STEPS {
                    let t = (i * N_STEPS + k) as f64 * h;
                    let s1 = slope(t, state);
                    let s2 = slope(t + h / 2.0, along(state, s1, h / 2.0));
                    let s3 = slope(t + h / 2.0, along(state, s2, h / 2.0));
                    let s4 = slope(t + h, along(state, s3, h));
                    let sum = along(along(s1, s4, 1.0), along(s2, s3, 1.0), 2.0);
                    state = along(state, sum, h / 6.0);
                }
                sampled
            })
            .collect()
    }
}
