//! The trait that every instrument, simulated instrument and recording implements.

use crate::Sample;

/// What one call of [`Device::read`] brought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// Samples were appended (possibly none, when nothing arrived in time); read again.
    More,
    /// The stream has ended and will bring nothing more.
    Ended,
}

/// A source of samples, read by one blocking thread.
pub trait Device {
    /// Name for messages: a port, a file.
    fn name(&self) -> &str;

    /// Appends the next samples, oldest first, to `samples` and says whether more can follow.
    ///
    /// The batch is bounded by the device, so a reader's memory does not grow with the stream.
    ///
    /// # Errors
    /// [`DeviceError`] when the source cannot be read further; samples appended before stay valid.
    fn read(&mut self, samples: &mut Vec<Sample>) -> Result<Reading, DeviceError>;
}

/// A device that cannot go on, with the driver's own error behind it.
#[derive(Debug, thiserror::Error)]
#[error("\"{device}\"")]
pub struct DeviceError {
    /// Name of the device.
    pub device: String,
    /// What the driver saw.
    #[source]
    pub source: Box<dyn std::error::Error + Send + Sync>,
}
