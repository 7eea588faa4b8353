//! Which instruments a campaign has: `[[device]]`, checked all at once.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::Quantity;
use crate::channel::{Channel, Lag};
use crate::driver::{Protocol, SettingsError, driver};
use crate::error::{ChannelClaim, InstrumentError};
use crate::port::{Line, Parity};
use crate::profile::{PaceSettings, Profile, profile};

/// One `[[device]]`: a profile, a port, and what differs from the profile.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceSetup {
    /// Its name in messages and recordings.
    pub name: String,
    /// Name of its profile.
    pub profile: String,
    /// Its port, best under /dev/serial/by-id.
    pub port: PathBuf,
    /// Bits per second, where they differ from the profile's.
    #[serde(default)]
    pub baud: Option<u32>,
    /// Parity, where it differs from the profile's.
    #[serde(default)]
    pub parity: Option<Parity>,
    /// When it is asked, where that differs from the profile's.
    #[serde(default)]
    pub pace: Option<PaceSettings>,
    /// Part of what it says it is, where that differs from the profile's.
    #[serde(default)]
    pub identity: Option<String>,
    /// Its filter, where it differs from the profile's.
    #[serde(default)]
    pub lag: Option<Lag>,
    /// Settings of the driver; each replaces the profile's of the same name.
    #[serde(default)]
    pub settings: toml::Table,
    /// What its fields measure.
    #[serde(default, rename = "channel")]
    pub channels: Vec<Channel>,
}

/// A device with everything decided; its text form is what a recording keeps of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeviceConfig {
    /// Its name.
    pub name: String,
    /// Its port.
    pub port: PathBuf,
    /// The port's settings.
    pub line: Line,
    /// When it is asked.
    pub pace: PaceSettings,
    /// Part of what it says it is.
    pub identity: Option<String>,
    /// Its filter.
    pub lag: Lag,
    /// Name of its driver.
    pub driver: String,
    /// The driver's settings.
    pub settings: toml::Table,
    /// Its channels.
    pub channels: Vec<Channel>,
}

impl DeviceSetup {
    /// An instrument by itself, named by its port, with settings as they stand in an inline table:
    /// `stations = [2], command = 40`.
    ///
    /// # Errors
    /// [`InstrumentError::Settings`] when that is no inline table.
    pub fn alone(port: PathBuf, profile: &str, settings: &str) -> Result<Self, InstrumentError> {
        let name = port.display().to_string();
        let table = format!("settings = {{ {settings} }}").parse::<toml::Table>();
        let settings = table.ok().and_then(|mut table| table.remove("settings"));
        let Some(toml::Value::Table(settings)) = settings else {
            return Err(InstrumentError::Settings {
                device: name,
                driver: profile.to_owned(),
                source: SettingsError(
                    "expected NAME = VALUE, NAME = VALUE, as in a campaign file".to_owned(),
                ),
            });
        };
        Ok(Self {
            name,
            profile: profile.to_owned(),
            port,
            baud: None,
            parity: None,
            pace: None,
            identity: None,
            lag: None,
            settings,
            channels: Vec::new(),
        })
    }

    /// Fills up from the named profile, and checks.
    ///
    /// # Errors
    /// The first mistake found.
    pub fn resolve(&self) -> Result<DeviceConfig, InstrumentError> {
        self.resolve_with(&profile(&self.profile)?)
    }

    /// Fills up from a profile of the laboratory's own, and checks.
    ///
    /// # Errors
    /// The first mistake found.
    pub fn resolve_with(&self, profile: &Profile) -> Result<DeviceConfig, InstrumentError> {
        let config = self.filled_up(profile);
        config.check(&self.profile)?;
        config.check_channels()?;
        Ok(config)
    }

    /// Fills up from the named profile, and checks all but the channels, of which it may have none:
    /// who looks at raw fields needs no more.
    ///
    /// # Errors
    /// The first mistake found.
    pub fn resolve_raw(&self) -> Result<DeviceConfig, InstrumentError> {
        let config = self.filled_up(&profile(&self.profile)?);
        config.check(&self.profile)?;
        Ok(config)
    }

    fn filled_up(&self, profile: &Profile) -> DeviceConfig {
        let mut line = profile.line;
        line.baud = self.baud.unwrap_or(line.baud);
        line.parity = self.parity.unwrap_or(line.parity);
        let mut settings = profile.settings.clone();
        settings.extend(self.settings.clone());
        DeviceConfig {
            name: self.name.clone(),
            port: self.port.clone(),
            line,
            pace: self.pace.unwrap_or(profile.pace),
            identity: self.identity.clone().or_else(|| profile.identity.clone()),
            lag: self.lag.clone().unwrap_or_else(|| profile.lag.clone()),
            driver: profile.driver.clone(),
            settings,
            channels: self.channels.clone(),
        }
    }
}

impl DeviceConfig {
    /// The protocol of this device.
    ///
    /// # Errors
    /// [`InstrumentError::UnknownDriver`] or [`InstrumentError::Settings`].
    pub fn protocol(&self) -> Result<Box<dyn Protocol>, InstrumentError> {
        let entry = driver(&self.driver).ok_or_else(|| InstrumentError::UnknownDriver {
            profile: self.name.clone(),
            driver: self.driver.clone(),
        })?;
        (entry.open)(&self.settings).map_err(|source| InstrumentError::Settings {
            device: self.name.clone(),
            driver: self.driver.clone(),
            source,
        })
    }

    fn check(&self, profile: &str) -> Result<(), InstrumentError> {
        let device = || self.name.clone();
        if driver(&self.driver).is_none() {
            let (profile, driver) = (profile.to_owned(), self.driver.clone());
            return Err(InstrumentError::UnknownDriver { profile, driver });
        }
        let number = |what, value, expected| {
            Err(InstrumentError::Number { device: device(), what, value, expected })
        };
        if self.line.baud == 0 {
            return number("baud", 0.0, "a positive number");
        }
        if !(7..=8).contains(&self.line.data_bits) {
            return number("data_bits", f64::from(self.line.data_bits), "7 or 8");
        }
        if !(1..=2).contains(&self.line.stop_bits) {
            return number("stop_bits", f64::from(self.line.stop_bits), "1 or 2");
        }
        if let Some((what, value)) = self.pace.fault() {
            return number(what, value, "a positive number");
        }
        let protocol = self.protocol()?;
        if let Some(expected) = self.identity.clone().filter(|_| !protocol.asks_who()) {
            let driver = self.driver.clone();
            return Err(InstrumentError::CannotAsk { device: device(), driver, expected });
        }
        self.check_stations(protocol.stations())
    }

    fn check_channels(&self) -> Result<(), InstrumentError> {
        let device = || self.name.clone();
        let fields = self.protocol()?.fields();
        if self.channels.is_empty() {
            return Err(InstrumentError::NoChannels { device: device() });
        }
        for channel in &self.channels {
            let Channel { quantity, field, .. } = *channel;
            if field >= fields.len() {
                return Err(InstrumentError::NoSuchField {
                    device: device(),
                    quantity,
                    field,
                    fields,
                });
            }
            channel.calibration.check().map_err(|source| InstrumentError::Calibration {
                device: device(),
                quantity,
                source,
            })?;
        }
        Ok(())
    }

    fn check_stations(&self, mut stations: Vec<u16>) -> Result<(), InstrumentError> {
        stations.sort_unstable();
        match stations.windows(2).find(|two| two[0] == two[1]) {
            Some(two) => Err(InstrumentError::AddressTwice {
                port: self.port.clone(),
                station: two[0],
                first: self.name.clone(),
                second: self.name.clone(),
            }),
            None => Ok(()),
        }
    }
}

/// Every mistake in a list of devices, and the devices that have none of their own.
pub fn check(setups: &[DeviceSetup]) -> (Vec<DeviceConfig>, Vec<InstrumentError>) {
    let mut configs = Vec::new();
    let mut mistakes = Vec::new();
    for setup in setups {
        match setup.resolve() {
            Ok(config) => configs.push(config),
            Err(mistake) => mistakes.push(mistake),
        }
    }
    mistakes.extend(between(&configs));
    (configs, mistakes)
}

/// Mistakes that take two devices.
fn between(configs: &[DeviceConfig]) -> Vec<InstrumentError> {
    let mut mistakes = Vec::new();
    let mut quantities: BTreeMap<Quantity, ChannelClaim> = BTreeMap::new();
    for (index, config) in configs.iter().enumerate() {
        for channel in &config.channels {
            let quantity = channel.quantity;
            let second = claim(config, channel.field);
            if let Some(first) = quantities.insert(quantity, second.clone()) {
                let claims = Box::new([first, second]);
                mistakes.push(InstrumentError::ChannelTwice { quantity, claims });
            }
        }
        for earlier in &configs[..index] {
            if earlier.name == config.name {
                mistakes.push(InstrumentError::NameTwice { device: config.name.clone() });
            }
            if same_port(earlier, config) {
                mistakes.push(on_one_port(earlier, config));
            }
        }
    }
    mistakes
}

fn claim(config: &DeviceConfig, field: usize) -> ChannelClaim {
    let fields = config.protocol().map(|protocol| protocol.fields()).unwrap_or_default();
    ChannelClaim {
        device: config.name.clone(),
        port: config.port.clone(),
        field,
        name: fields.get(field).cloned().unwrap_or_default(),
    }
}

/// Two names may lead to one port.
fn same_port(a: &DeviceConfig, b: &DeviceConfig) -> bool {
    let device = |config: &DeviceConfig| std::fs::canonicalize(&config.port).ok();
    a.port == b.port || device(a).is_some_and(|device_a| device(b) == Some(device_a))
}

fn on_one_port(a: &DeviceConfig, b: &DeviceConfig) -> InstrumentError {
    let stations = |config: &DeviceConfig| {
        config.protocol().map(|protocol| protocol.stations()).unwrap_or_default()
    };
    let (first, second) = (a.name.clone(), b.name.clone());
    let port = b.port.clone();
    let theirs = stations(b);
    match stations(a).into_iter().find(|station| theirs.contains(station)) {
        Some(station) => InstrumentError::AddressTwice { port, station, first, second },
        None => InstrumentError::PortTwice { port, first, second },
    }
}
