//! What can be wrong with an instrument, said with device, port, and what was seen.

use std::path::PathBuf;

use crate::Quantity;
use crate::channel::CalibrationError;
use crate::driver::SettingsError;
use crate::port::PortFault;

/// A setup that cannot work, or a link that does not; [`InstrumentError::hint`] says what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InstrumentError {
    /// No profile of that name.
    #[error("no profile is called \"{profile}\"")]
    UnknownProfile {
        /// The name.
        profile: String,
        /// The names there are.
        known: Vec<&'static str>,
    },
    /// A profile that cannot be read.
    #[error("profile \"{profile}\": {seen}")]
    Profile {
        /// Its name.
        profile: String,
        /// The mistake and its place.
        seen: String,
    },
    /// A driver that does not exist.
    #[error("profile \"{profile}\" names the driver \"{driver}\", which does not exist")]
    UnknownDriver {
        /// The profile.
        profile: String,
        /// The driver.
        driver: String,
    },
    /// Settings that the driver cannot work with.
    #[error("device \"{device}\": settings of driver \"{driver}\": {source}")]
    Settings {
        /// The device.
        device: String,
        /// The driver.
        driver: String,
        /// The mistake.
        source: SettingsError,
    },
    /// A number that makes no sense.
    #[error("device \"{device}\": {what} is {value}, expected {expected}")]
    Number {
        /// The device.
        device: String,
        /// Which setting.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A device that measures nothing.
    #[error("device \"{device}\" has no channel")]
    NoChannels {
        /// The device.
        device: String,
    },
    /// A field that the driver does not deliver.
    #[error("device \"{device}\": {} is to come from field {field}, but the fields are {}",
        quantity.name(), numbered(fields))]
    NoSuchField {
        /// The device.
        device: String,
        /// The channel.
        quantity: Quantity,
        /// The field asked for.
        field: usize,
        /// Names of the fields there are.
        fields: Vec<String>,
    },
    /// A calibration that gives no value.
    #[error("device \"{device}\": {}: {source}", quantity.name())]
    Calibration {
        /// The device.
        device: String,
        /// The channel.
        quantity: Quantity,
        /// The mistake.
        source: CalibrationError,
    },
    /// Two devices with one name.
    #[error("two devices are called \"{device}\"")]
    NameTwice {
        /// The name.
        device: String,
    },
    /// Two devices on one port.
    #[error("devices \"{first}\" and \"{second}\" are both on port \"{}\"", port.display())]
    PortTwice {
        /// The port.
        port: PathBuf,
        /// A device on it.
        first: String,
        /// Another.
        second: String,
    },
    /// Two devices at one address of a bus.
    #[error("devices \"{first}\" and \"{second}\" both have address {station} on port \"{}\"",
        port.display())]
    AddressTwice {
        /// The port.
        port: PathBuf,
        /// The address.
        station: u16,
        /// A device with it.
        first: String,
        /// Another, or the same once more.
        second: String,
    },
    /// A quantity that two channels claim.
    #[error("{} is mapped twice: by {} and by {}", quantity.name(), claims[0], claims[1])]
    ChannelTwice {
        /// The quantity.
        quantity: Quantity,
        /// The two channels that claim it.
        claims: Box<[ChannelClaim; 2]>,
    },
    /// A port that cannot be opened.
    #[error("device \"{device}\": port \"{}\" {}", port.display(), told(fault))]
    Port {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// Why not.
        fault: PortFault,
        /// Ports that are there.
        present: Vec<PathBuf>,
    },
    /// Bytes that never make a frame.
    #[error("device \"{device}\": port \"{}\" brings garbage at {line}: {n_bytes} bytes without \
        one good frame, such as {seen}", port.display())]
    Garbage {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// The line's settings.
        line: String,
        /// How many bytes.
        n_bytes: u64,
        /// Some of them.
        seen: String,
    },
    /// Nothing comes.
    #[error("device \"{device}\": nothing comes from port \"{}\" at {line}{}", port.display(),
        asked(request.as_deref()))]
    Silent {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// The line's settings.
        line: String,
        /// What was asked, when anything was.
        request: Option<String>,
    },
    /// Answers of one station that are damaged, one after the other.
    #[error("device \"{device}\": port \"{}\" brings damaged answers{}: {n_answers} more than good \
        ones, asked \"{request}\", such as {seen}", port.display(), at_address(*station))]
    Collided {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// The address that was asked, where the bus has such.
        station: Option<u16>,
        /// How many more were damaged than not.
        n_answers: u32,
        /// The question.
        request: String,
        /// Bytes of the last answer.
        seen: String,
    },
    /// Another kind of instrument answers.
    #[error("device \"{device}\": port \"{}\" answers \"{seen}\", expected is \"{expected}\"",
        port.display())]
    WrongDevice {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// Part of what it should say.
        expected: String,
        /// What it said.
        seen: String,
    },
    /// The instrument talks, but not about itself.
    #[error("device \"{device}\": port \"{}\" brings readings but does not say who it is, asked \
        \"{request}\", expected is \"{expected}\"", port.display())]
    NotSaid {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// Part of what it should say.
        expected: String,
        /// The question.
        request: String,
    },
    /// An identity that is to be compared with nothing.
    #[error(
        "device \"{device}\": identity is \"{expected}\", but driver \"{driver}\" with these \
        settings has no way to ask the instrument who it is"
    )]
    CannotAsk {
        /// The device.
        device: String,
        /// Its driver.
        driver: String,
        /// Part of what it should say.
        expected: String,
    },
    /// The instrument refuses a request.
    #[error("device \"{device}\": port \"{}\" refuses \"{request}\": \"{reply}\"", port.display())]
    Refused {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// The request.
        request: String,
        /// What came back.
        reply: String,
    },
    /// Answers that nobody asked for.
    #[error("device \"{device}\": port \"{}\" brings answers that nobody asked for: {seen}",
        port.display())]
    Unasked {
        /// The device.
        device: String,
        /// Its port.
        port: PathBuf,
        /// One of them.
        seen: String,
    },
}

impl InstrumentError {
    /// The device that it is about, the later one where there are two.
    pub fn device(&self) -> Option<&str> {
        match self {
            Self::UnknownProfile { .. } | Self::Profile { .. } | Self::UnknownDriver { .. } => None,
            Self::Settings { device, .. }
            | Self::Number { device, .. }
            | Self::NoChannels { device }
            | Self::NoSuchField { device, .. }
            | Self::Calibration { device, .. }
            | Self::NameTwice { device }
            | Self::Port { device, .. }
            | Self::Garbage { device, .. }
            | Self::Silent { device, .. }
            | Self::Collided { device, .. }
            | Self::WrongDevice { device, .. }
            | Self::NotSaid { device, .. }
            | Self::CannotAsk { device, .. }
            | Self::Refused { device, .. }
            | Self::Unasked { device, .. } => Some(device),
            Self::PortTwice { second, .. } | Self::AddressTwice { second, .. } => Some(second),
            Self::ChannelTwice { claims, .. } => Some(&claims[1].device),
        }
    }
}

/// A channel that claims a quantity: where its values come from.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("device \"{device}\" from field {field} ({name}) of port \"{}\"", port.display())]
pub struct ChannelClaim {
    /// The device.
    pub device: String,
    /// Its port.
    pub port: PathBuf,
    /// The field.
    pub field: usize,
    /// The field as the driver names it.
    pub name: String,
}

fn at_address(station: Option<u16>) -> String {
    station.map(|station| format!(" of address {station}")).unwrap_or_default()
}

fn numbered(fields: &[String]) -> String {
    let named = fields.iter().enumerate().map(|(number, name)| format!("{number} ({name})"));
    named.collect::<Vec<_>>().join(", ")
}

fn asked(request: Option<&str>) -> String {
    request.map(|request| format!(", asked \"{request}\"")).unwrap_or_default()
}

fn told(fault: &PortFault) -> String {
    match fault {
        PortFault::Missing => "does not exist".to_owned(),
        PortFault::Busy => "is in use by another program".to_owned(),
        PortFault::Forbidden => "may not be opened by this user".to_owned(),
        PortFault::NotSerial => "is no serial port".to_owned(),
        PortFault::Refused(what) => format!("refuses {what}"),
        PortFault::Other(seen) => format!("cannot be opened: {seen}"),
    }
}
