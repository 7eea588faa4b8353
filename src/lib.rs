//! What we learn from the samples: runs, damping, reports.
//!
//! Each module may use those listed above it, never those below; `tests/architecture.rs` holds
//! them to it.

pub mod hull;
pub mod roll;

pub mod run;

pub mod settling;

pub mod model;

pub mod judgement;

pub mod campaign;

pub mod inverse;

pub mod results;

pub mod procedure;

pub mod uncertainty;

pub mod progress;

pub mod diagnosis;

pub mod tank;

pub mod reference;

pub mod catalogue;

pub mod report;

pub mod pipeline;

pub mod page;

pub mod live;

pub mod bench;

pub mod command;
