//! How late an instrument's own filter makes its readings, compensated or flagged.

use serde::{Deserialize, Serialize};

/// No model rolls faster [rad/s], so that a filter does no worse to any roll than here.
const FASTEST_ROLL_RAD_S: f64 = 10.0;
/// What a filter must leave of the amplitude of such a roll for readings to pass unflagged.
const KEPT_SHARE: f64 = 0.98;

/// The declared lag of a device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lag {
    /// What the filter is like.
    pub kind: LagKind,
    /// Delay, averaging time or time constant [s].
    #[serde(default)]
    pub time_s: f64,
    /// Which setting of the instrument it belongs to.
    #[serde(default)]
    pub note: String,
}

/// The form of a filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LagKind {
    /// No filter.
    None,
    /// Every frequency is late by `time_s`.
    Delay,
    /// A mean over `time_s`: late by half of it.
    Mean,
    /// A first-order filter of time constant `time_s`.
    FirstOrder,
    /// A filter that nobody declared: readings are flagged.
    Unknown,
}

impl Default for Lag {
    fn default() -> Self {
        Self { kind: LagKind::Unknown, time_s: 0.0, note: String::new() }
    }
}

impl Lag {
    /// By how much a reading is older than its time stamp says [s], at low frequency.
    pub fn delay_s(&self) -> f64 {
        match self.kind {
            LagKind::None | LagKind::Unknown => 0.0,
            LagKind::Delay | LagKind::FirstOrder => self.time_s,
            LagKind::Mean => self.time_s / 2.0,
        }
    }

    /// What is left of the lag [s] at most, at any frequency of a roll, after [`Lag::delay_s`] is
    /// taken off.
    pub fn bound_s(&self) -> f64 {
        self.remainder_s(FASTEST_ROLL_RAD_S).abs()
    }

    /// What is left of the lag [s] at a frequency [rad/s] after [`Lag::delay_s`] is taken off.
    pub fn remainder_s(&self, frequency_rad_s: f64) -> f64 {
        match self.kind {
            LagKind::FirstOrder if frequency_rad_s > 0.0 => {
                (frequency_rad_s * self.time_s).atan() / frequency_rad_s - self.time_s
            }
            _ => 0.0,
        }
    }

    /// What the filter leaves of an amplitude at a frequency [rad/s].
    pub fn gain(&self, frequency_rad_s: f64) -> f64 {
        let turn = frequency_rad_s * self.time_s;
        match self.kind {
            LagKind::FirstOrder => 1.0 / (1.0 + turn * turn).sqrt(),
            LagKind::Mean if turn > 0.0 => (turn / 2.0).sin() / (turn / 2.0),
            _ => 1.0,
        }
    }

    /// Whether it is known how late readings are.
    pub fn is_declared(&self) -> bool {
        self.kind != LagKind::Unknown
    }

    /// Whether nobody knows how late readings are, or the filter may shrink a roll.
    pub fn is_flagged(&self) -> bool {
        !self.is_declared() || self.gain(FASTEST_ROLL_RAD_S) < KEPT_SHARE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dsc_filter_of_the_manual_lags_and_shrinks_a_roll() {
        // FFST = 30 at 100 Hz: 63 % after 0.3 s.
        let lag = Lag { kind: LagKind::FirstOrder, time_s: 0.3, note: String::new() };
        let roll_rad_s = std::f64::consts::TAU / 2.0;
        assert!((lag.delay_s() - 0.3).abs() < 1e-12);
        let phase = roll_rad_s * (lag.delay_s() + lag.remainder_s(roll_rad_s));
        assert!((phase - (0.3 * roll_rad_s).atan()).abs() < 1e-12);
        assert!((lag.gain(roll_rad_s) - 0.727_7).abs() < 1e-4);
        // Taking 0.3 s off is too much for any roll: the bound says so, and readings are flagged.
        assert!(lag.is_flagged() && (lag.bound_s() - 0.3 + 3.0_f64.atan() / 10.0).abs() < 1e-12);
        let fast = Lag { time_s: 0.01, ..lag };
        assert!(!fast.is_flagged() && (1e-5..1e-4).contains(&fast.bound_s()));
    }

    #[test]
    fn an_adam_integrates_over_fifty_milliseconds() {
        let lag = Lag { kind: LagKind::Mean, time_s: 0.05, note: String::new() };
        assert!((lag.delay_s() - 0.025).abs() < 1e-12);
        assert!((lag.gain(std::f64::consts::PI) - 0.998_97).abs() < 1e-4);
        assert!(Lag::default().is_flagged() && !lag.is_flagged() && lag.bound_s() == 0.0);
    }
}
