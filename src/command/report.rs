//! `rolltank report`: the report of a campaign in a folder of choice.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::method::Identifying;
use super::{Exit, Failure, replaying};
use crate::campaign::{self, Campaign};
use crate::pipeline;
use crate::report::Extent;

/// Write the pages, tables and catalogue of a campaign to a folder
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Folder for the report, outside the campaign or below its results/
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print a summary to report.pdf too, with an installed Chromium or Chrome
    #[arg(long)]
    pdf: bool,
    /// Print every page of every run, not only how well its law describes it
    #[arg(long, requires = "pdf")]
    every_page: bool,
    #[command(flatten)]
    identifying: Identifying,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let dir = &arguments.output;
    require_apart(&campaign, dir)?;
    let replayed = replaying::replay(&campaign, arguments.identifying, None, Some(dir))?;
    writeln!(out, "report: {}", dir.join(pipeline::REPORT_PAGE).display())?;
    if arguments.pdf {
        let extent = if arguments.every_page { Extent::EveryPage } else { Extent::Summary };
        let printed = pipeline::print_report(&campaign.name, &replayed.results, dir, extent)?;
        writeln!(out, "printed: {}", printed.display())?;
    }
    Ok(replayed.exit)
}

/// Refuses a folder in which the tables of the report would be taken for recordings.
pub(super) fn require_apart(campaign: &Campaign, dir: &Path) -> Result<(), Failure> {
    let results = pipeline::results_folder(campaign);
    let wanted = resolved(dir);
    if wanted.starts_with(resolved(&campaign.folder)) && !wanted.starts_with(resolved(&results)) {
        return Err(Failure::InsideCampaign { path: dir.to_owned(), results });
    }
    Ok(())
}

/// One name for one folder, however it was written and whether or not it is there yet.
fn resolved(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let there = absolute.ancestors().find_map(|above| {
        let below = absolute.strip_prefix(above).ok()?;
        Some(above.canonicalize().ok()?.join(below))
    });
    there.unwrap_or(absolute)
}
