//! `rolltank demo`: the paper's campaign, simulated, replayed and reported without any hardware.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::fresh_folder::{next_free, require_fresh};
use super::method::Identifying;
use super::simulate::simulated;
use super::{Exit, Failure, replaying, tables};
use crate::campaign;
use crate::pipeline;
use crate::tank::Scenario;

/// Simulate the paper's campaign in a new folder, replay it and print its damping
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder for the campaign: new or empty [default: rolltank-demo, or the next free number]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    identifying: Identifying,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let folder = arguments.output.clone().unwrap_or_else(|| next_free("rolltank-demo"));
    require_fresh(&folder)?;
    let scenario = Scenario::builtin("paper").expect("the paper's campaign is built in");
    simulated(&scenario, arguments.identifying.seed(), &folder)?;
    writeln!(out, "campaign: {} (simulated)", folder.display())?;
    out.flush()?;
    let campaign = campaign::read(&folder)?;
    let dir = pipeline::results_folder(&campaign);
    let replayed = replaying::replay(&campaign, arguments.identifying, None, Some(&dir))?;
    tables::human(out, &replayed.results)?;
    writeln!(out, "\nreport: {}", dir.join(pipeline::REPORT_PAGE).display())?;
    Ok(replayed.exit)
}
