//! The instruments of a scenario: rate, noise, quantisation and clock of each recorded channel.

use devices::Quantity;
use serde::Deserialize;
use serde::Deserializer;

/// One instrument, in the SI unit of its quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instrument {
    /// Samples per second [Hz].
    pub sample_rate_hz: f64,
    /// Standard deviation of the noise.
    pub noise: f64,
    /// Step of the digitiser; zero for none.
    pub quantum: f64,
    /// Standard deviation of the sampling instants about an even grid [s]; the stamps tell it.
    pub time_jitter_s: f64,
    /// How late the stamps of this channel are [s]; the stamps do not tell it.
    pub clock_offset_s: f64,
}

impl Instrument {
    /// Whether both channels are scanned at the same instants and so can share a time column.
    pub fn shares_clock(&self, other: &Self) -> bool {
        let clock = |i: &Self| [i.sample_rate_hz, i.time_jitter_s, i.clock_offset_s];
        // Settings, not results: either the file gives the same number or it does not.
        clock(self).map(f64::to_bits) == clock(other).map(f64::to_bits)
    }

    /// The same instrument without noise, steps or jitter.
    #[must_use]
    pub fn ideal(self) -> Self {
        Self { noise: 0.0, quantum: 0.0, time_jitter_s: 0.0, ..self }
    }

    /// Standard deviation of what noise and quantisation add to a value.
    pub fn total_noise(&self) -> f64 {
        self.noise.hypot(self.quantum / 12.0_f64.sqrt())
    }
}

/// The recorded channels; one left out is not recorded.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instruments {
    /// `[instruments.roll]`: `sample_rate_hz`, `noise_deg`, `quantum_deg`, `time_jitter_s`,
    /// `clock_offset_s`.
    #[serde(deserialize_with = "roll")]
    pub roll: Instrument,
    /// `[instruments.force]`: the same with `noise_n`, `quantum_n`.
    #[serde(default, deserialize_with = "recorded_force")]
    pub force: Option<Instrument>,
    /// `[instruments.moment]`: the same with `noise_n_m`, `quantum_n_m`.
    #[serde(default, deserialize_with = "recorded_moment")]
    pub moment: Option<Instrument>,
    /// `[instruments.speed]`: the same with `noise_m_s`, `quantum_m_s`.
    #[serde(default, deserialize_with = "recorded_speed")]
    pub speed: Option<Instrument>,
}

impl Instruments {
    /// The same channels without noise, steps or jitter.
    #[must_use]
    pub fn ideal(&self) -> Self {
        Self {
            roll: self.roll.ideal(),
            force: self.force.map(Instrument::ideal),
            moment: self.moment.map(Instrument::ideal),
            speed: self.speed.map(Instrument::ideal),
        }
    }

    /// The recorded channels in the order of [`Quantity::ALL`].
    pub fn recorded(&self) -> Vec<(Quantity, Instrument)> {
        let of = |quantity| match quantity {
            Quantity::Roll => Some(self.roll),
            Quantity::Force => self.force,
            Quantity::Moment => self.moment,
            Quantity::Speed => self.speed,
        };
        Quantity::ALL.into_iter().filter_map(|q| of(q).map(|i| (q, i))).collect()
    }
}

/// Declares the reader of one `[instruments.*]` table, whose noise and quantum keys carry a unit.
macro_rules! reader {
    ($reader:ident, $noise:literal, $quantum:literal, $si_per_unit:expr) => {
        fn $reader<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Instrument, D::Error> {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Keys {
                sample_rate_hz: f64,
                #[serde(default, rename = $noise)]
                noise: f64,
                #[serde(default, rename = $quantum)]
                quantum: f64,
                #[serde(default)]
                time_jitter_s: f64,
                #[serde(default)]
                clock_offset_s: f64,
            }
            let keys = Keys::deserialize(deserializer)?;
            Ok(Instrument {
                sample_rate_hz: keys.sample_rate_hz,
                noise: keys.noise * $si_per_unit,
                quantum: keys.quantum * $si_per_unit,
                time_jitter_s: keys.time_jitter_s,
                clock_offset_s: keys.clock_offset_s,
            })
        }
    };
}

reader!(roll, "noise_deg", "quantum_deg", 1.0_f64.to_radians());
reader!(force, "noise_n", "quantum_n", 1.0);
reader!(moment, "noise_n_m", "quantum_n_m", 1.0);
reader!(speed, "noise_m_s", "quantum_m_s", 1.0);

/// An optional table, read by `reader` when it is there.
macro_rules! optional {
    ($name:ident, $reader:ident) => {
        fn $name<'de, D: Deserializer<'de>>(
            deserializer: D,
        ) -> Result<Option<Instrument>, D::Error> {
            $reader(deserializer).map(Some)
        }
    };
}

optional!(recorded_force, force);
optional!(recorded_moment, moment);
optional!(recorded_speed, speed);

/// `[recordings]`: how the files are written.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RecordingFormat {
    /// `"csv"` or `"mcap"`.
    pub format: FileFormat,
    /// What stands between the values of a CSV row.
    pub delimiter: char,
    /// Whether CSV numbers are written with a decimal comma.
    pub decimal_comma: bool,
    /// Unit of the roll column of a CSV file, `"deg"` or `"rad"`.
    pub roll_unit: RollUnit,
    /// Whether each channel goes to a CSV file of its own.
    pub one_file_per_channel: bool,
}

impl Default for RecordingFormat {
    fn default() -> Self {
        Self {
            format: FileFormat::Csv,
            delimiter: ',',
            decimal_comma: false,
            roll_unit: RollUnit::Deg,
            one_file_per_channel: false,
        }
    }
}

/// The file format of the recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FileFormat {
    /// Delimited text.
    Csv,
    /// MCAP.
    Mcap,
}

/// Unit of the roll column of a CSV recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RollUnit {
    /// Degrees.
    Deg,
    /// Radians.
    Rad,
}
