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
//! A session is one recording: its instruments are attached when it begins and detached when it
//! ends, so that its raw bytes alone give its samples again. While nothing is recorded, by hand or
//! for want of room, a session remembers the last seconds of its links; the recording that follows
//! takes over links and seconds, and begins with them (attaching). The daemon runs one session
//! after the other; every queue between threads is bounded, and what finds no place is counted.

mod attached;
mod attaching;
mod daemon;
mod diagnosing;
mod ended;
mod error;
mod event;
mod keeping;
mod provisional;
mod reporting;
mod session;
mod showing;
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
