//! `rolltank simulate`: a campaign folder from a scenario, its truth sealed beside it.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::fresh_folder::require_fresh;
use super::terminal::Terminal;
use super::{Exit, Failure};
use crate::tank::{self, Scenario};

/// Write a simulated campaign from a scenario file, or from a built-in scenario such as `paper`
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A scenario file, or the name of a built-in scenario
    scenario: String,
    /// Folder for the campaign: new or empty
    #[arg(short, long, value_name = "CAMPAIGN")]
    output: PathBuf,
    /// Seed of everything random
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let scenario = named(&arguments.scenario)?;
    require_fresh(&arguments.output)?;
    simulated(&scenario, arguments.seed, &arguments.output)?;
    writeln!(out, "campaign: {}", arguments.output.display())?;
    Ok(Exit::Done)
}

/// Simulates a campaign into a folder with progress on the terminal.
pub(super) fn simulated(scenario: &Scenario, seed: u64, folder: &Path) -> Result<(), Failure> {
    let terminal = Terminal::new();
    let mut progress = |done, total| terminal.show(done, total, "simulated passes".to_owned());
    Ok(tank::write_campaign(scenario, seed, folder, &mut progress)?)
}

/// A built-in scenario unless a file of that name is there.
fn named(name: &str) -> Result<Scenario, Failure> {
    let path = PathBuf::from(name);
    if !path.exists()
        && let Some(scenario) = Scenario::builtin(name)
    {
        return Ok(scenario);
    }
    let text =
        std::fs::read_to_string(&path).map_err(|source| Failure::ScenarioFile { path, source })?;
    Ok(Scenario::parse(&text, name)?)
}
