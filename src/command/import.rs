//! `rolltank import`: recordings in tables or foreign files become MCAP files of our own.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::replaying::log_notes;
use super::terminal::Terminal;
use super::{Exit, Failure};
use crate::campaign::{self, FILE_NAME};
use crate::pipeline;

/// Write every recording of a campaign as an MCAP file that other programs open and plot
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Folder for the MCAP files [default: CAMPAIGN/results]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    let dir = arguments.output.clone().unwrap_or_else(|| pipeline::results_folder(&campaign));
    fs::create_dir_all(&dir).map_err(|source| Failure::File { path: dir.clone(), source })?;
    let path = campaign.folder.join(FILE_NAME);
    let text = fs::read_to_string(&path).map_err(|source| Failure::File { path, source })?;
    let terminal = Terminal::new();
    let mut exit = Exit::Done;
    for (recording, label) in campaign.recordings.iter().zip(pipeline::labels(&campaign.recordings))
    {
        let target = dir.join(format!("{label}.mcap"));
        let imported = ::replay::import(
            &recording.name,
            &recording.files,
            &campaign.columns,
            &target,
            &text,
            &mut |read, total| terminal.show(read, total, recording.name.clone()),
        )?;
        if terminal.pause(|| log_notes(&recording.name, &imported.notes)) > 0 {
            exit = Exit::Incomplete;
        }
        let n_samples: u64 = imported.samples.iter().map(|(_, n)| n).sum();
        writeln!(out, "{} -> {}, {n_samples} samples", recording.name, target.display())?;
    }
    Ok(exit)
}
