//! How runs are kept and played back: MCAP and CSV recordings as devices.
//!
//! Reading, from the outside in: [`Player`] merges streams in time order; a stream is one file on
//! one time base, a delimited table or a topic of an MCAP file; [`Recorded`] gives back everything
//! that one of our own recordings holds. Writing: [`Recorder`], which a crash takes nothing from,
//! [`recover`] after one, and [`import()`] from any recording to one of our own.

mod columns;
mod csv_file;
mod csv_stream;
mod documents;
mod ending;
mod error;
mod flat_json;
mod folder;
mod gaps;
mod hint;
mod import;
mod json_field;
mod link;
mod link_decoder;
mod link_losses;
mod live_stream;
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
mod record;
mod recorded;
mod recorder;
mod sources;
mod stamps;
mod stream;
mod topics;

pub use columns::{ChannelColumn, Columns, TimeColumn};
pub use error::ReplayError;
pub use folder::list_recordings;
pub use import::{ImportReport, import};
pub use link_decoder::LinkDecoder;
pub use link_losses::LinkLosses;
pub use live_stream::LIVE_SOURCE;
pub use nearest::edit_distance;
pub use note::{Note, Severity};
pub use number::CellFault;
pub use player::Player;
pub use record::{
    AttachedDevice, Calibration, CampaignFile, ChannelCounts, ClockReading, Direction, ExitStatus,
    Gap, Loss, LossKind, QualityChange, Raw, Record, Rejection, RunResult, RunStart, RunStop,
};
pub use recorded::Recorded;
pub use recorder::{
    ClosedRecording, Disk, Exit, Fate, Finished, LocalDisk, Orphan, PreTrigger, Progress,
    Provenance, Recorder, Settings, recover,
};
