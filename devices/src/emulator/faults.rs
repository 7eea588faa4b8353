//! What can be made to go wrong with an emulated instrument, on command.

/// A fault, commanded from outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// So many bytes of noise come before what is sent next.
    Noise(usize),
    /// Nothing is sent, and what should have been is sent late, when it is switched off.
    Stall(bool),
    /// Nothing is answered or sent, and nothing is kept.
    Mute(bool),
    /// So many samples are sent twice.
    Repeat(u64),
    /// So many samples are not sent.
    Skip(u64),
    /// The instrument's clock is fast by so many parts per million.
    DriftPpm(f64),
    /// The input is over-driven.
    Saturate(bool),
    /// The instrument's line is set to so many bits per second, whatever the port is set to.
    Baud(u32),
    /// The power fails for a moment: counters start anew.
    Restart,
}

/// The faults in force.
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Faults {
    pub(super) noise_bytes: usize,
    pub(super) stalled: bool,
    pub(super) mute: bool,
    pub(super) n_repeats: u64,
    pub(super) n_skips: u64,
    pub(super) drift_ppm: f64,
    pub(super) saturated: bool,
    pub(super) restart: bool,
    pub(super) baud: Option<u32>,
}

impl Faults {
    /// Puts a fault in force.
    pub fn command(&mut self, fault: Fault) {
        match fault {
            Fault::Noise(n_bytes) => self.noise_bytes += n_bytes,
            Fault::Stall(on) => self.stalled = on,
            Fault::Mute(on) => self.mute = on,
            Fault::Repeat(n_samples) => self.n_repeats += n_samples,
            Fault::Skip(n_samples) => self.n_skips += n_samples,
            Fault::DriftPpm(drift_ppm) => self.drift_ppm = drift_ppm,
            Fault::Saturate(on) => self.saturated = on,
            Fault::Baud(baud) => self.baud = Some(baud),
            Fault::Restart => self.restart = true,
        }
    }

    /// Whether the reading that is due is not sent.
    pub(super) fn skips(&mut self) -> bool {
        let is_skipped = self.n_skips > 0;
        self.n_skips = self.n_skips.saturating_sub(1);
        is_skipped
    }

    /// Whether the reading that is due is the one before once more.
    pub(super) fn repeats(&mut self) -> bool {
        let is_repeated = self.n_repeats > 0;
        self.n_repeats = self.n_repeats.saturating_sub(1);
        is_repeated
    }

    /// The value, or one beyond every range when the input is over-driven.
    pub(super) fn limited(&self, raw: f64, limit: f64) -> f64 {
        if self.saturated { limit } else { raw.clamp(-limit, limit) }
    }

    /// Bytes of noise that are due; they repeat exactly from run to run.
    pub(super) fn noise(&mut self) -> Vec<u8> {
        let noise = |index: usize| (index * 167 + index / 7 * 59 + 13) as u8;
        let n_bytes = std::mem::take(&mut self.noise_bytes);
        (0..n_bytes).map(noise).collect()
    }
}
