//! Excitations that do not repeat: a sweep through frequencies, an irregular mixture of them.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::equation::RollState;
use super::imposed::{Kinematics, settle, smooth_step};

/// Tones of an irregular excitation: enough that it looks Gaussian and never repeats in a pass.
const N_TONES: usize = 48;

/// A band of frequencies [rad/s]; a sweep runs from the first to the second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Band {
    /// Where it begins [rad/s].
    pub(super) from_rad_s: f64,
    /// Where it ends [rad/s].
    pub(super) to_rad_s: f64,
}

impl Band {
    /// The frequency in the middle [rad/s].
    pub(super) fn middle_rad_s(&self) -> f64 {
        0.5 * (self.from_rad_s + self.to_rad_s)
    }
}

/// A pure tone `a sin(w t + p)`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tone {
    amplitude: f64,
    frequency_rad_s: f64,
    phase_rad: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Sweep { amplitude: f64, band: Band, duration_s: f64 },
    Tones(Vec<Tone>),
}

/// An excitation that grows from nothing within its ramp, in the unit of its amplitude.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Excitation {
    shape: Shape,
    ramp_s: f64,
}

impl Excitation {
    /// `a sin(theta)` whose frequency runs evenly through the band within `duration_s`.
    pub(super) fn sweep(amplitude: f64, band: Band, duration_s: f64, ramp_s: f64) -> Self {
        Self { shape: Shape::Sweep { amplitude, band, duration_s }, ramp_s }
    }

    /// Tones of equal size spread over the band, their frequencies and phases drawn.
    pub(super) fn irregular(rms: f64, band: Band, ramp_s: f64, draws: &mut ChaCha8Rng) -> Self {
        let amplitude = rms * (2.0 / N_TONES as f64).sqrt();
        let width_rad_s = (band.to_rad_s - band.from_rad_s) / N_TONES as f64;
        let tones = (0..N_TONES)
            .map(|k| {
                // One tone in each slice: evenly spaced ones would repeat after a while.
                let place = k as f64 + draws.random::<f64>();
                let frequency_rad_s = band.from_rad_s + width_rad_s * place;
                Tone { amplitude, frequency_rad_s, phase_rad: TAU * draws.random::<f64>() }
            })
            .collect();
        Self { shape: Shape::Tones(tones), ramp_s }
    }

    /// Value and its first two derivatives in time after `elapsed_s`.
    pub(super) fn at(&self, elapsed_s: f64) -> [f64; 3] {
        let [x, dx, ddx] = self.grown(elapsed_s);
        let [_, s, ds, dds] = smooth_step(elapsed_s / self.ramp_s);
        let (ds, dds) = (ds / self.ramp_s, dds / self.ramp_s.powi(2));
        [s * x, ds * x + s * dx, dds * x + 2.0 * ds * dx + s * ddx]
    }

    /// The same without the ramp.
    fn grown(&self, t: f64) -> [f64; 3] {
        match &self.shape {
            Shape::Sweep { amplitude, band, duration_s } => {
                let change = (band.to_rad_s - band.from_rad_s) / duration_s;
                let w = band.from_rad_s + change * t;
                let (sin, cos) = (band.from_rad_s * t + 0.5 * change * t * t).sin_cos();
                let slopes = [sin, w * cos, change * cos - w * w * sin];
                slopes.map(|slope| amplitude * slope)
            }
            Shape::Tones(tones) => tones.iter().fold([0.0; 3], |sum, tone| {
                let w = tone.frequency_rad_s;
                let (sin, cos) = (w * t + tone.phase_rad).sin_cos();
                let slopes = [sin, w * cos, -w * w * sin];
                std::array::from_fn(|k| sum[k] + tone.amplitude * slopes[k])
            }),
        }
    }
}

/// A roll that follows an excitation about the position of rest, joined to the motion before it.
#[derive(Debug, Clone)]
pub(super) struct Following {
    /// What is left of the motion before.
    pub(super) left_over: RollState,
    /// Position of rest [rad].
    pub(super) rest_roll_rad: f64,
    /// What the roll follows [rad].
    pub(super) excitation: Excitation,
}

impl Following {
    /// Follows `excitation` from the state `from`.
    pub(super) fn new(from: RollState, rest_roll_rad: f64, excitation: Excitation) -> Self {
        let left_over = RollState { roll_rad: from.roll_rad - rest_roll_rad, ..from };
        Self { left_over, rest_roll_rad, excitation }
    }

    /// Motion after `elapsed_s` from the start of the action.
    pub(super) fn at(&self, elapsed_s: f64) -> Kinematics {
        let [roll, rate, acceleration] = self.excitation.at(elapsed_s);
        let followed = Kinematics {
            roll_rad: self.rest_roll_rad + roll,
            rate_rad_per_s: rate,
            acceleration_rad_per_s2: acceleration,
        };
        followed.plus(settle(self.left_over, elapsed_s, self.excitation.ramp_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::rand_core::SeedableRng;

    const BAND: Band = Band { from_rad_s: 4.0, to_rad_s: 9.0 };

    #[test]
    fn the_derivatives_are_those_of_the_value() {
        let mut draws = ChaCha8Rng::seed_from_u64(5);
        let irregular = Excitation::irregular(0.05, BAND, 2.0, &mut draws);
        for excitation in [irregular, Excitation::sweep(0.1, BAND, 30.0, 3.0)] {
            for t in [0.4, 1.3, 1.9, 7.7, 21.0] {
                let h = 1e-5;
                let (a, m, b) = (excitation.at(t - h), excitation.at(t), excitation.at(t + h));
                // Central differences of size 1e-5 are good to about h^2 times the derivative.
                assert!(((b[0] - a[0]) / (2.0 * h) - m[1]).abs() < 1e-7, "rate at {t} s");
                assert!(((b[1] - a[1]) / (2.0 * h) - m[2]).abs() < 1e-6, "acceleration at {t} s");
            }
        }
    }

    #[test]
    fn an_irregular_excitation_has_the_size_asked_for() {
        let mut draws = ChaCha8Rng::seed_from_u64(6);
        let excitation = Excitation::irregular(0.05, BAND, 1.0, &mut draws);
        let n = 60_000;
        let square: f64 = (0..n).map(|k| excitation.at(1.0 + f64::from(k) * 0.01)[0].powi(2)).sum();
        let rms = (square / f64::from(n)).sqrt();
        // 600 s over a band of 5 rad/s are some 500 independent values: 3 %.
        assert!((rms / 0.05 - 1.0).abs() < 0.1, "{rms}");
    }
}
