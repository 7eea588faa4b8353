//! `rolltank run`: the daemon, until a signal ends it.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use devices::clock::WallClock;

use super::{Exit, Failure, tables};
use crate::live::{self, DaemonOptions, SharedStatus};

/// Seconds in a minute.
const MINUTE_S: f64 = 60.0;

/// Attach to the instruments, record, find runs, identify each as it ends, until SIGTERM
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Minutes after which a recording gives way to the next, at the first rest of the model
    #[arg(long, value_name = "MINUTES", default_value_t = 30.0, value_parser = super::positive)]
    rotate: f64,
    /// Seconds of the instruments' own time in one second, for simulated instruments
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = super::positive, hide = true)]
    clock_speed: f64,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let options =
        DaemonOptions { folder: arguments.campaign.clone(), rotate_s: MINUTE_S * arguments.rotate };
    let clock = Arc::new(WallClock::start_at_speed(arguments.clock_speed));
    let status = SharedStatus::default();
    let results = live::run(&options, &clock, live::orders(), &status)?;
    if let Some(results) = results {
        tables::human(out, &results)?;
    }
    Ok(Exit::Done)
}
