//! Where samples come from: channels, samples, and the trait every instrument implements.
//!
//! A recording is a device too: `replay::Player` implements [`Device`], so everything above reads
//! a live instrument and last year's file through the same door.

pub mod clock;
mod device;
pub mod driver;
mod quality;
mod sample;

pub use device::{Device, DeviceError, Reading};
pub use quality::Quality;
pub use sample::{Quantity, Sample};
