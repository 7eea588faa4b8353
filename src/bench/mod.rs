//! What the program can do, measured: how often its bands hold the truth, how fast it is.

pub mod acquisition;
pub mod calibration;
pub mod diagnosis;
pub mod drawn_run;
pub mod live;
pub mod page;
pub mod paper_hyperpriors;
pub mod ranks;
pub mod speed;

mod machine;
mod pages;
mod stopwatch;

pub use calibration::{Calibration, calibrate};
pub use machine::machine;
