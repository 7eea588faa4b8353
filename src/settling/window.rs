//! The level of the roll over windows of a few seconds, with its noise taken off.

use crate::run::SampleNoise;

/// Length of a window [s]: two periods of a slow model, five of a quick one.
const LENGTH_S: f64 = 6.0;
/// A hole this long [s] ends a window unused.
const HOLE_S: f64 = 1.0;

/// The roll over one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Level {
    /// Middle of the window [s].
    pub(super) time_s: f64,
    /// Amplitude of a sine with the variance that noise does not explain [rad].
    pub(super) roll_rad: f64,
    /// Amplitude below which nothing is told from noise [rad].
    pub(super) blur_rad: f64,
}

impl Level {
    /// Logarithm of the level, of the blur where the level is lost in it.
    pub(super) fn log(&self) -> f64 {
        self.roll_rad.max(self.blur_rad).ln()
    }

    /// Variance that the noise gives the logarithm.
    pub(super) fn log_variance(&self) -> f64 {
        let share = self.blur_rad / self.roll_rad.max(self.blur_rad);
        0.25 * share.powi(4)
    }
}

/// Sums over the window under way.
#[derive(Debug, Default)]
pub(super) struct Windows {
    noise: SampleNoise,
    start_s: f64,
    last_s: Option<f64>,
    n: f64,
    sum_t: f64,
    sum_tt: f64,
    sum_x: f64,
    sum_tx: f64,
    sum_xx: f64,
    /// The first value, taken off all, so that a heel costs no digits.
    zero_rad: f64,
}

impl Windows {
    /// Takes a sample; gives the level of the window that it completes.
    pub(super) fn push(&mut self, time_s: f64, roll_rad: f64) -> Option<Level> {
        let after_hole = self.last_s.is_some_and(|last_s| time_s - last_s > HOLE_S);
        if after_hole {
            self.noise.interrupt();
        }
        self.noise.push(roll_rad);
        let full = !after_hole && self.n > 0.0 && time_s - self.start_s >= LENGTH_S;
        let level = full.then(|| self.level());
        if full || after_hole || self.n < 0.5 {
            let noise = std::mem::take(&mut self.noise);
            *self = Self { noise, start_s: time_s, zero_rad: roll_rad, ..Self::default() };
        }
        self.last_s = Some(time_s);
        let (t, x) = (time_s - self.start_s, roll_rad - self.zero_rad);
        self.n += 1.0;
        self.sum_t += t;
        self.sum_tt += t * t;
        self.sum_x += x;
        self.sum_tx += t * x;
        self.sum_xx += x * x;
        level
    }

    /// Variance about a line, since a drift of the zero is no roll.
    fn level(&self) -> Level {
        let n = self.n;
        let mean_t = self.sum_t / n;
        let (tt, tx) = (self.sum_tt - n * mean_t * mean_t, self.sum_tx - mean_t * self.sum_x);
        let xx = self.sum_xx - self.sum_x * self.sum_x / n;
        let slope = if tt > 0.0 { tx / tt } else { 0.0 };
        let variance = ((xx - slope * tx) / n).max(0.0);
        let noise = self.noise.sd().powi(2);
        // The variance of white noise over n samples is known to this much; two of it are a blur.
        let blur = 2.0 * noise * (2.0 / n).sqrt();
        Level {
            time_s: self.start_s + 0.5 * LENGTH_S,
            roll_rad: (2.0 * (variance - noise).max(0.0)).sqrt(),
            blur_rad: (2.0 * blur).sqrt().max(f64::MIN_POSITIVE),
        }
    }
}
