//! `rolltank report`: the report of a campaign in a folder of choice.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::method::Identifying;
use super::{Exit, Failure, replaying};
use crate::campaign;
use crate::pipeline;

/// Write the pages, tables and catalogue of a campaign to a folder
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Folder for the report
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    identifying: Identifying,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let dir = &arguments.output;
    let replayed = replaying::replay(&campaign, arguments.identifying, None, Some(dir))?;
    writeln!(out, "report: {}", dir.join(pipeline::REPORT_PAGE).display())?;
    Ok(replayed.exit)
}
