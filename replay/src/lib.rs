//! How runs are kept and played back: MCAP and CSV recordings as devices.
//!
//! Reading, from the outside in: [`Player`] merges streams in time order; a stream is one file on
//! one time base, a delimited table or a topic of an MCAP file. Writing: [`Recorder`], and
//! [`import()`] from the one to the other.

mod columns;
mod csv_file;
mod csv_stream;
mod error;
mod folder;
mod gaps;
mod hint;
mod import;
mod json_field;
mod mcap_inventory;
mod mcap_records;
mod mcap_stream;
mod message;
mod nearest;
mod note;
mod number;
mod player;
mod protobuf_field;
mod protobuf_schema;
mod protobuf_wire;
mod recorder;
mod sources;
mod stamps;
mod stream;
mod topics;

pub use columns::{ChannelColumn, Columns, TimeColumn};
pub use error::ReplayError;
pub use folder::list_recordings;
pub use import::{ImportReport, import};
pub use nearest::edit_distance;
pub use note::{Note, Severity};
pub use number::CellFault;
pub use player::Player;
pub use recorder::{Provenance, Recorder};
