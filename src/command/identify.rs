//! `rolltank identify`: the runs of a campaign and what they say, without writing anything.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::method::Identifying;
use super::{Exit, Failure, replaying, tables};
use crate::campaign;

/// Print the damping per run and against Froude number; writes no file
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    #[command(flatten)]
    identifying: Identifying,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let replayed = replaying::replay(&campaign, arguments.identifying, None, None)?;
    if arguments.json {
        tables::json(out, &campaign, &replayed.results)?;
    } else {
        tables::human(out, &replayed.results)?;
    }
    Ok(replayed.exit)
}
