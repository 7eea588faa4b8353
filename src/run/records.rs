//! Keeps what the channels showed lately, and where the model was still.

use std::collections::VecDeque;

use super::Still;
use super::bins::Bin;
use super::carriage_pass::CarriagePass;
use super::drive::Drive;
use super::noise::BinNoise;
use super::noise::Quantum;
use super::noise::SampleNoise;
use super::ripple::Ripple;
use super::track::Track;

/// Longest still stretch that is averaged [s]; also how long every sample is kept.
pub(super) const KEPT_S: f64 = 20.0;
/// How long before a run its roll is kept [s]: heeling the model and holding it there.
pub(super) const LEAD_S: f64 = 12.0;
/// Still stretches remembered: the rest, and those at the heel at which the model was held after
/// it, which a trembling hand breaks.
const N_STILL: usize = 16;
/// Standard deviation of three bins weighted 1/4, 1/2, 1/4.
const SMOOTHED: f64 = 0.612;

/// The channels of one recording.
#[derive(Debug, Clone, Default)]
pub(super) struct Records {
    /// Samples of the roll [rad].
    pub(super) roll: Track,
    /// Samples of the drive.
    pub(super) drive: Drive,
    /// The carriage.
    pub(super) carriage: CarriagePass,
    sample_noise: SampleNoise,
    bin_noise: BinNoise,
    quantum: Quantum,
    still: VecDeque<Still>,
}

impl Records {
    /// Takes a roll sample; gives the bin that it completes.
    pub(super) fn push_roll(&mut self, time_s: f64, roll_rad: f64) -> Option<Bin> {
        self.sample_noise.push(roll_rad);
        self.quantum.push(roll_rad);
        let bin = self.roll.push(time_s, roll_rad)?;
        self.bin_noise.push(bin.value);
        Some(bin)
    }

    /// The next roll sample does not follow the last one.
    pub(super) fn interrupt_roll(&mut self) {
        self.roll.interrupt();
        self.sample_noise.interrupt();
        self.bin_noise.interrupt();
    }

    /// What noise and quantum do to the roll.
    pub(super) fn ripple(&self) -> Ripple {
        let quantum_rad = self.quantum.step();
        let step_sd_rad = quantum_rad / 12.0_f64.sqrt();
        // A vibration is noise of the bins more than of the samples; of a channel so slow that
        // each bin is one sample the bins' estimate is the quicker one.
        let fine = self.roll.averages();
        let sample_sd_rad = if fine { self.sample_noise.sd() } else { 0.0 };
        Ripple {
            sd_rad: SMOOTHED * self.bin_noise.sd(),
            quantum_rad,
            lost_below_rad: 3.0 * sample_sd_rad.max(self.bin_noise.sd()).max(step_sd_rad),
        }
    }

    /// Remembers that the model was still from `start_s` to `end_s`.
    pub(super) fn note_still(&mut self, start_s: f64, end_s: f64) {
        let start_s = start_s.max(end_s - KEPT_S);
        let Some(roll_rad) = self.roll.mean(start_s, end_s) else { return };
        let force = self.drive.track.mean(start_s, end_s);
        if self.still.len() == N_STILL {
            self.still.pop_front();
        }
        let roll_sd_rad = self.roll.sd(start_s, end_s, roll_rad);
        self.still.push_back(Still { start_s, end_s, roll_rad, roll_sd_rad, force });
    }

    /// The last still stretch before `start_s` in which the roll was within `reach_rad` of
    /// `mean_rad`, the mean of the run: a model held at heel is still too, but not at its zero.
    pub(super) fn still_before(
        &self,
        start_s: f64,
        mean_rad: f64,
        reach_rad: f64,
    ) -> Option<Still> {
        let fits = |s: &&Still| s.end_s <= start_s && (s.roll_rad - mean_rad).abs() <= reach_rad;
        self.still.iter().rev().find(fits).copied()
    }

    /// Drops samples older than `time_s` on every channel.
    pub(super) fn forget_before(&mut self, time_s: f64) {
        self.roll.forget_before(time_s);
        self.drive.track.forget_before(time_s);
        self.carriage.track.forget_before(time_s);
    }

    /// Number of samples kept on the channel that has most.
    pub(super) fn n_samples(&self) -> usize {
        let drive = self.drive.track.n_samples();
        self.roll.n_samples().max(drive).max(self.carriage.track.n_samples())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_known_behind_a_hold_that_a_trembling_hand_breaks() {
        let mut records = Records::default();
        for k in 0..1400 {
            let time_s = f64::from(k) * 0.01;
            records.push_roll(time_s, if time_s < 6.0 { 0.001 } else { 0.2 });
        }
        records.note_still(0.0, 6.0);
        for k in 7..14 {
            records.note_still(f64::from(k), f64::from(k) + 0.8);
        }
        let still = records.still_before(14.0, 0.0, 0.1).expect("the model was at rest");
        assert!((still.end_s - 6.0).abs() < 1e-9 && (still.roll_rad - 0.001).abs() < 1e-4);
    }
}
