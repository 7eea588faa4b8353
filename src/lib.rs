//! What we learn from the samples: runs, damping, reports.
//!
//! Each module may use those listed above it, never those below; `tests/architecture.rs` holds
//! them to it.

pub mod hull;
pub mod roll;
pub mod run;
pub mod inverse;
pub mod campaign;
pub mod results;
