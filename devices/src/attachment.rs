//! What a recording keeps of an instrument, so that its bytes can be decoded again next year.

use serde::{Deserialize, Serialize};

use crate::channel::Calibration;
use crate::driver::Session;
use crate::error::InstrumentError;
use crate::interpreter::Interpreter;
use crate::setup::DeviceConfig;

/// A device as it was attached: everything decided, and the adapter in front of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Attachment {
    /// What its adapter may hold back [s].
    pub latency_s: f64,
    /// The device.
    pub device: DeviceConfig,
}

/// An attachment that cannot be written or read as text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct AttachmentError(String);

impl Attachment {
    /// As the text of a TOML table.
    ///
    /// # Errors
    /// [`AttachmentError`] when the port's path is no text.
    pub fn to_text(&self) -> Result<String, AttachmentError> {
        toml::to_string(self).map_err(|error| AttachmentError(error.to_string()))
    }

    /// From that text.
    ///
    /// # Errors
    /// [`AttachmentError`] with the place of the mistake.
    pub fn from_text(text: &str) -> Result<Self, AttachmentError> {
        toml::from_str(text).map_err(|error| AttachmentError(error.to_string()))
    }

    /// A conversation and an interpreter that have not begun.
    ///
    /// # Errors
    /// [`InstrumentError`] when the driver does not take the settings.
    pub fn start(&self) -> Result<(Session, Interpreter), InstrumentError> {
        let Self { latency_s, device } = self;
        let session = Session::new(device.protocol()?, device.pace.pace(&device.line));
        Ok((session, Interpreter::new(device, *latency_s)?))
    }
}

impl Calibration {
    /// As the text of a TOML table.
    pub fn to_text(&self) -> String {
        // It holds texts and numbers alone, which TOML always has a form for.
        toml::to_string(self).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::DeviceSetup;

    #[test]
    fn every_setting_comes_back_from_the_text() {
        let text = "name = \"cell\"\nprofile = \"adam-4017\"\nport = \"/dev/ttyUSB0\"\n\
            settings = { modules = [{ address = 1 }, { address = 2 }], checksum = true }\n\
            [[channel]]\nquantity = \"roll\"\nfield = 0\nrange = [-1.0, 1.0]\n\
            calibration = { zero_raw = 0.1, curve = { table = [[0.0, 0.0], [0.1, 1.0]] } }\n\
            [[channel]]\nquantity = \"force\"\nfield = 1\n";
        let setup: DeviceSetup = toml::from_str(text).unwrap();
        let attached = Attachment { latency_s: 0.1 + 0.2, device: setup.resolve().unwrap() };
        let text = attached.to_text().unwrap();
        assert_eq!(Attachment::from_text(&text).unwrap(), attached, "{text}");
        assert!(attached.start().is_ok());
    }
}
