//! Instruments known by name: `profiles/*.toml`, each with its manual.

use serde::{Deserialize, Serialize};

use crate::channel::Lag;
use crate::driver::Pace;
use crate::error::InstrumentError;
use crate::port::Line;

/// What the makers deliver, one file each.
const PROFILES: [(&str, &str); 11] = [
    ("adam-4017", include_str!("../profiles/adam-4017.toml")),
    ("arduino-text", include_str!("../profiles/arduino-text.toml")),
    ("cobs-board", include_str!("../profiles/cobs-board.toml")),
    ("hbm-ad104", include_str!("../profiles/hbm-ad104.toml")),
    ("hbm-ad104-binary", include_str!("../profiles/hbm-ad104-binary.toml")),
    ("mantrabus-dsc", include_str!("../profiles/mantrabus-dsc.toml")),
    ("mantracourt-dsc", include_str!("../profiles/mantracourt-dsc.toml")),
    ("mantracourt-dscusb", include_str!("../profiles/mantracourt-dscusb.toml")),
    ("modbus-transmitter", include_str!("../profiles/modbus-transmitter.toml")),
    ("nmea-speed-log", include_str!("../profiles/nmea-speed-log.toml")),
    ("scale-continuous", include_str!("../profiles/scale-continuous.toml")),
];

/// A kind of instrument, as its maker sets it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// What it is, for lists.
    pub title: String,
    /// Which driver speaks to it.
    pub driver: String,
    /// Where all this is written.
    pub manual: Vec<String>,
    /// Its serial line.
    pub line: Line,
    /// When it is asked.
    #[serde(default)]
    pub pace: PaceSettings,
    /// Part of what it says it is.
    #[serde(default)]
    pub identity: Option<String>,
    /// Its own filter.
    #[serde(default)]
    pub lag: Lag,
    /// The driver's settings.
    #[serde(default)]
    pub settings: toml::Table,
}

/// When an instrument is asked, and how late its readings come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaceSettings {
    /// Cycles in a second; as many as answers come when left out.
    #[serde(default)]
    pub rate_hz: Option<f64>,
    /// Longest wait for an answer [s]; 0.1 when left out.
    #[serde(default)]
    pub timeout_s: Option<f64>,
    /// From opening the port until the instrument has started [s].
    #[serde(default)]
    pub boot_s: f64,
    /// Age of a reading when it is asked for, at most [s]: one conversion.
    #[serde(default)]
    pub age_s: f64,
    /// The instrument sends by its own crystal at this rate [Hz], without sequence or time.
    #[serde(default)]
    pub sends_hz: Option<f64>,
}

impl PaceSettings {
    /// For the state machine, on that line.
    pub fn pace(&self, line: &Line) -> Pace {
        let ns = |time_s: f64| (time_s.max(0.0) * 1e9) as u64;
        let byte_ns = line.byte_ns();
        Pace {
            period_ns: self.rate_hz.map_or(0, |rate_hz| ns(1.0 / rate_hz)),
            timeout_ns: ns(self.timeout_s.unwrap_or(0.1)),
            // Modbus asks for 3.5 characters of silence, 1.75 ms above 19200; nobody minds it.
            gap_ns: (7 * byte_ns / 2).min(1_750_000),
            byte_ns,
            boot_ns: ns(self.boot_s),
        }
    }

    /// The first setting that makes no sense.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64)> {
        let positive = |value: Option<f64>| value.is_none_or(|value| value > 0.0);
        let settings = [
            ("rate_hz", positive(self.rate_hz), self.rate_hz),
            ("timeout_s", positive(self.timeout_s), self.timeout_s),
            ("sends_hz", positive(self.sends_hz), self.sends_hz),
            ("boot_s", self.boot_s >= 0.0, Some(self.boot_s)),
            ("age_s", self.age_s >= 0.0, Some(self.age_s)),
        ];
        let wrong = settings.into_iter().find(|(_, good, _)| !good);
        wrong.map(|(name, _, value)| (name, value.unwrap_or(f64::NAN)))
    }
}

/// Names of all profiles.
pub fn profiles() -> impl Iterator<Item = &'static str> {
    PROFILES.iter().map(|(name, _)| *name)
}

/// The profile of that name.
///
/// # Errors
/// [`InstrumentError::UnknownProfile`], or [`InstrumentError::Profile`] when its file is wrong.
pub fn profile(name: &str) -> Result<Profile, InstrumentError> {
    let Some((_, text)) = PROFILES.iter().find(|(known, _)| *known == name) else {
        return Err(InstrumentError::UnknownProfile {
            profile: name.to_owned(),
            known: profiles().collect(),
        });
    };
    read(name, text)
}

/// Reads a profile, such as one that a laboratory keeps beside its campaigns.
///
/// # Errors
/// [`InstrumentError::Profile`] with the place of the mistake.
pub fn read(name: &str, text: &str) -> Result<Profile, InstrumentError> {
    toml::from_str(text).map_err(|error| InstrumentError::Profile {
        profile: name.to_owned(),
        seen: error.to_string().trim_end().to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::driver;

    #[test]
    fn every_profile_is_read_names_its_manual_and_opens_its_driver() {
        for name in profiles() {
            let profile = profile(name).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(!profile.manual.is_empty(), "{name} names no manual");
            let driver = driver(&profile.driver).unwrap_or_else(|| panic!("{name}: driver"));
            let opened = (driver.open)(&profile.settings);
            // Some settings are the laboratory's: which registers, which parameter.
            let left_open = ["modbus-rtu", "mantrabus"].contains(&driver.name);
            assert!(opened.is_ok() || left_open, "{name}: {:?}", opened.err());
            assert_eq!(profile.pace.fault(), None, "{name}");
        }
    }

    #[test]
    fn a_mistake_in_a_profile_is_told_with_its_place() {
        let error = read("own", "title = \"x\"\ndriver = 3").unwrap_err().to_string();
        assert!(error.contains("\"own\"") && error.contains("line 2"), "{error}");
    }
}
