//! How runs are kept and played back: MCAP and CSV recordings as devices.

mod columns;

pub use columns::{ChannelColumn, Columns, TimeColumn};
