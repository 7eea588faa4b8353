//! What the daemon shows and may be asked: its status, its strips, the live page, over HTTP.
//!
//! ```text
//! daemon -> Board (status, strips, judgements, what was learnt) -> server -> browser
//! daemon <- Orders, judgements.jsonl, calibrations.toml         <- server <- browser
//! ```
//!
//! The daemon writes to the board and never waits for it; whoever looks costs the server's own
//! thread, and nothing else.

mod assets;
mod board;
mod metrics;
mod motion;
mod order;
mod pass;
mod server;
mod stamp;
pub mod status;
mod strips;
mod words;
mod zeroing;

pub use board::{Board, Shown};
pub use motion::Motion;
pub use order::{Order, Orders, orders};
pub use pass::Pass;
pub use server::{Listen, ServeError, Served, runtime, serve};
pub use stamp::{stamp, stamp_of_now};
pub use status::Status;
pub use strips::Strips;
