//! What is done to the model during a pass, one action after the other.

use serde::Deserialize;
use serde::Deserializer;

use super::excitation::Band;

/// One thing done to the model; the next action starts where this one ends.
///
/// In the file each action is a table with one key, its name:
/// ```toml
/// action = [
///   { rest = { duration_s = 5.0 } },
///   { hold = { heel_deg = 12.0, duration_s = 4.0 } },
///   { release = { duration_s = 25.0 } },
/// ]
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", rename_all_fields = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// The model is left alone; nothing is measured on purpose.
    Rest {
        /// Length [s].
        duration_s: f64,
    },
    /// A hand or a line heels the model and holds it there.
    Hold {
        /// Heel from the position of rest [rad], `heel_deg` in the file.
        #[serde(rename = "heel_deg", deserialize_with = "degrees")]
        heel_rad: f64,
        /// Length, the way there included [s].
        duration_s: f64,
        /// Time taken to heel the model [s].
        #[serde(default = "one")]
        ramp_s: f64,
        /// Trembling of the hand [rad], `tremor_deg` in the file.
        #[serde(default, rename = "tremor_deg", deserialize_with = "degrees")]
        tremor_rad: f64,
    },
    /// A hand rocks the model up to an amplitude; follow it with `release`.
    Rock {
        /// Amplitude reached at the end [rad], `amplitude_deg` in the file.
        #[serde(rename = "amplitude_deg", deserialize_with = "degrees")]
        amplitude_rad: f64,
        /// Frequency of the rocking [rad/s].
        frequency_rad_s: f64,
        /// Length [s].
        duration_s: f64,
    },
    /// The model is let go and rolls freely: a decay.
    Release {
        /// Length, the letting go included [s].
        duration_s: f64,
        /// Time over which the holding moment fades [s]; zero for a clean release.
        #[serde(default)]
        fade_s: f64,
    },
    /// A blow, then free rolling: a new decay, in the middle of another one if need be.
    Strike {
        /// Roll impulse [N m s]; positive rolls to starboard.
        impulse_n_m_s: f64,
        /// How long the blow lasts [s].
        #[serde(default = "tenth")]
        blow_s: f64,
        /// Length, the blow included [s].
        duration_s: f64,
    },
    /// A hand stops the model and stays on it.
    Catch {
        /// Length [s].
        duration_s: f64,
        /// Damping ratio with the hand on [-]; above 1 the model creeps back to rest.
        #[serde(default = "one_and_a_half")]
        damping_ratio: f64,
    },
    /// The rod imposes `A cos(w t)` about the position of rest, with the moment that it takes.
    Forced {
        /// Roll amplitude [rad], `amplitude_deg` in the file.
        #[serde(rename = "amplitude_deg", deserialize_with = "degrees")]
        amplitude_rad: f64,
        /// Frequency [rad/s].
        frequency_rad_s: f64,
        /// Length, the start-up included [s].
        duration_s: f64,
        /// Start-up, or the change from the frequency and amplitude before [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
    /// The rod brings the model to its position of rest and holds it.
    Stop {
        /// Length [s].
        duration_s: f64,
        /// Time taken to stop [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
    /// The rod applies a sinusoidal moment and the model answers as it will.
    Driven {
        /// Amplitude of the moment [N m].
        moment_n_m: f64,
        /// Frequency [rad/s].
        frequency_rad_s: f64,
        /// Length, the start-up included [s].
        duration_s: f64,
        /// Time in which the moment grows to its amplitude [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
    /// The rod imposes a roll whose frequency runs evenly from one value to another.
    ForcedSweep {
        /// Roll amplitude [rad], `amplitude_deg` in the file.
        #[serde(rename = "amplitude_deg", deserialize_with = "degrees")]
        amplitude_rad: f64,
        /// First frequency [rad/s].
        from_rad_s: f64,
        /// Last frequency [rad/s].
        to_rad_s: f64,
        /// Length of the sweep, the start-up included [s].
        duration_s: f64,
        /// Time in which the roll grows to its amplitude [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
    /// The rod imposes an irregular roll with frequencies from a band.
    ForcedIrregular {
        /// Root mean square of the roll [rad], `rms_deg` in the file.
        #[serde(rename = "rms_deg", deserialize_with = "degrees")]
        rms_rad: f64,
        /// Lower end of the band [rad/s].
        from_rad_s: f64,
        /// Upper end of the band [rad/s].
        to_rad_s: f64,
        /// Length, the start-up included [s].
        duration_s: f64,
        /// Time in which the roll grows to its size [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
    /// The rod applies a moment whose frequency runs evenly from one value to another.
    DrivenSweep {
        /// Amplitude of the moment [N m].
        moment_n_m: f64,
        /// First frequency [rad/s].
        from_rad_s: f64,
        /// Last frequency [rad/s].
        to_rad_s: f64,
        /// Length of the sweep, the start-up included [s].
        duration_s: f64,
        /// Time in which the moment grows to its amplitude [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
    /// The rod applies an irregular moment with frequencies from a band.
    DrivenIrregular {
        /// Root mean square of the moment [N m].
        rms_n_m: f64,
        /// Lower end of the band [rad/s].
        from_rad_s: f64,
        /// Upper end of the band [rad/s].
        to_rad_s: f64,
        /// Length, the start-up included [s].
        duration_s: f64,
        /// Time in which the moment grows to its size [s].
        #[serde(default = "two")]
        ramp_s: f64,
    },
}

impl Action {
    /// Length of the action [s].
    pub fn duration_s(&self) -> f64 {
        match *self {
            Self::Rest { duration_s }
            | Self::Hold { duration_s, .. }
            | Self::Rock { duration_s, .. }
            | Self::Release { duration_s, .. }
            | Self::Strike { duration_s, .. }
            | Self::Catch { duration_s, .. }
            | Self::Forced { duration_s, .. }
            | Self::Stop { duration_s, .. }
            | Self::Driven { duration_s, .. }
            | Self::ForcedSweep { duration_s, .. }
            | Self::ForcedIrregular { duration_s, .. }
            | Self::DrivenSweep { duration_s, .. }
            | Self::DrivenIrregular { duration_s, .. } => duration_s,
        }
    }

    /// Name in the scenario file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Rest { .. } => "rest",
            Self::Hold { .. } => "hold",
            Self::Rock { .. } => "rock",
            Self::Release { .. } => "release",
            Self::Strike { .. } => "strike",
            Self::Catch { .. } => "catch",
            Self::Forced { .. } => "forced",
            Self::Stop { .. } => "stop",
            Self::Driven { .. } => "driven",
            Self::ForcedSweep { .. } => "forced_sweep",
            Self::ForcedIrregular { .. } => "forced_irregular",
            Self::DrivenSweep { .. } => "driven_sweep",
            Self::DrivenIrregular { .. } => "driven_irregular",
        }
    }

    /// The band of frequencies of an excitation that does not repeat.
    pub(super) fn band(&self) -> Option<Band> {
        match *self {
            Self::ForcedSweep { from_rad_s, to_rad_s, .. }
            | Self::ForcedIrregular { from_rad_s, to_rad_s, .. }
            | Self::DrivenSweep { from_rad_s, to_rad_s, .. }
            | Self::DrivenIrregular { from_rad_s, to_rad_s, .. } => {
                Some(Band { from_rad_s, to_rad_s })
            }
            _ => None,
        }
    }
}

/// Reads an angle in degrees into radians.
pub(super) fn degrees<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    f64::deserialize(deserializer).map(f64::to_radians)
}

fn tenth() -> f64 {
    0.1
}

fn one() -> f64 {
    1.0
}

fn one_and_a_half() -> f64 {
    1.5
}

fn two() -> f64 {
    2.0
}
