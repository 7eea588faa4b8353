//! The daemon: instruments in, recordings, runs and reports out, all day.
//!
//! ```text
//! port threads -> Event -> one loop -> recorder            (keeping)
//!                           |    \---> run finder -> identifying threads -> reporter (reporting)
//!                           |              |                               |
//!                           |              |                               \---> (diagnosing)
//!                           |              \---> the run so far (provisional)
//!                           \---> board -> page
//! ```
//!
//! A session is one recording, or a time without one. The next takes over its open links and the
//! last seconds that they brought (remembered), and begins with them (attaching): those that are
//! recorded already bring decoders and clocks to where they were, the others are its own, so that
//! no byte is lost between two recordings and the raw bytes of each alone give its samples again.
//! Only other instruments are attached anew. The daemon runs one session after the other; every
//! queue between threads is bounded, and what finds no place is counted.

mod attached;
mod attaching;
mod channel;
mod daemon;
mod diagnosing;
mod ended;
mod error;
mod event;
mod keeping;
mod provisional;
mod remembered;
mod reporting;
mod session;
mod showing;
#[cfg(test)]
mod stalled;
mod supervisor;
mod telling;
mod under_way;
mod virtual_day;
mod virtual_plan;
mod virtual_tank;

pub use daemon::{DaemonOptions, run};
pub use error::LiveError;
pub use virtual_day::{DayEnded, DayProgress, virtual_day};
pub use virtual_tank::VirtualTank;
