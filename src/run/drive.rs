//! Tells how strongly the rod drives the roll, against the noise of its force.

use super::harmonic::Harmonic;
use super::noise::BinNoise;
use super::noise::Quantum;
use super::track::Track;

/// The oscillation of the drive over one roll cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DriveSwing {
    /// Amplitude at the roll frequency [N or N m].
    pub(super) amplitude: f64,
    /// What noise and quantum alone can show.
    pub(super) noise: f64,
}

impl DriveSwing {
    /// Whether it stands out of the noise.
    pub(super) fn is_significant(&self) -> bool {
        self.amplitude > 5.0 * self.noise
    }
}

/// The force of the rod, or the moment recorded instead of it.
#[derive(Debug, Clone, Default)]
pub(super) struct Drive {
    /// Its samples.
    pub(super) track: Track,
    noise: BinNoise,
    quantum: Quantum,
}

impl Drive {
    /// Takes a sample.
    pub(super) fn push(&mut self, time_s: f64, value: f64) {
        if self.track.hole_before(time_s).is_some() {
            self.track.interrupt();
            self.noise.interrupt();
        }
        self.quantum.push(value);
        if let Some(bin) = self.track.push(time_s, value) {
            self.noise.push(bin.value);
        }
    }

    /// Whether a drive is recorded.
    pub(super) fn is_recorded(&self) -> bool {
        self.track.last_s().is_some()
    }

    /// Standard deviation of a bin, the quantum included.
    pub(super) fn sd(&self) -> f64 {
        self.noise.sd().max(self.quantum.step() / 12.0_f64.sqrt())
    }

    /// Its oscillation over the full cycle that ends at `end_s`.
    pub(super) fn swing(&self, end_s: f64, half_period_s: f64) -> Option<DriveSwing> {
        let bins = self.track.bins(end_s - 2.0 * half_period_s, end_s);
        let n = bins.clone().count() as f64;
        let fit = Harmonic::fit(bins, std::f64::consts::PI / half_period_s, 0.0)?;
        Some(DriveSwing {
            amplitude: fit.amplitude(),
            noise: self.sd() * (2.0 / n).sqrt() + 0.1 * self.quantum.step(),
        })
    }
}
