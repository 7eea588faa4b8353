//! `rolltank replay`: the whole pipeline from recordings, leaving the report in `results/`.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::method::Identifying;
use super::{Exit, Failure, replaying, tables};
use crate::campaign;
use crate::pipeline;

/// Play every recording, identify each run as it ends, leave the report in CAMPAIGN/results/
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Recorded seconds to play in one second; as fast as it goes when left out
    #[arg(long, value_name = "X", value_parser = super::positive)]
    speed: Option<f64>,
    #[command(flatten)]
    identifying: Identifying,
    /// Print the identification as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let dir = pipeline::results_folder(&campaign);
    let replayed =
        replaying::replay(&campaign, arguments.identifying, arguments.speed, Some(&dir))?;
    if arguments.json {
        tables::json(out, &campaign, &replayed.results)?;
    } else {
        tables::human(out, &replayed.results)?;
        writeln!(out, "\nreport: {}", dir.join(pipeline::REPORT_PAGE).display())?;
    }
    Ok(replayed.exit)
}
