//! Where samples come from: channels, samples, and the trait every instrument implements.
//!
//! A recording is a device too: `replay::Player` implements [`Device`], so everything above reads
//! a live instrument and last year's file through the same door.
//!
//! ```text
//! port (thread, bytes, time stamps) -> driver (frames) -> instrument (SI, host time, quality)
//! ```

mod attachment;
pub mod channel;
pub mod clock;
mod device;
pub mod driver;
pub mod emulator;
mod error;
mod hint;
mod instrument;
mod interpreter;
pub mod port;
pub mod probe;
pub mod profile;
mod quality;
mod realtime;
mod sample;
pub mod setup;
mod stamp;
mod trouble;

pub use attachment::{Attachment, AttachmentError};
pub use device::{Device, DeviceError, Reading};
pub use error::{ChannelClaim, InstrumentError};
pub use instrument::{AttachedInstrument, Instrument};
pub use interpreter::{InstrumentEvent, Interpreter, Measured};
pub use quality::Quality;
pub use sample::{Quantity, Sample};
