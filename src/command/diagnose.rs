//! `rolltank diagnose`: what the simulation gets wrong, its cause, and what mending it gains.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use super::{Exit, Failure, heap, tables};
use crate::campaign::{self, Campaign};
use crate::model::model_file::ModelFile;
use crate::pipeline::{self, Observed, Options};
use crate::report;
use crate::results::Results;
use crate::run::LEFT_ITS_COURSE;

/// Show what the simulation gets wrong, name the cause, and measure what mending it gains
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Print JSON instead of sentences
    #[arg(long)]
    json: bool,
    /// Write the extended model to results/model.toml of the campaign
    #[arg(long)]
    write_model: bool,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    heap::go_on_with(heap::OF_A_SEARCH);
    let campaign = campaign::read(&arguments.campaign)?;
    let mut observed = Observed::default();
    let options = Options { keep_histories: false, ..Options::default() };
    let results = pipeline::replay(&campaign, &options, &mut |_| {}, &mut |learnt| {
        observed.hear(learnt, &campaign);
        Ok(())
    })?;
    let observed = observed.judged(&campaign.judgements);
    for reason in observed.left_out() {
        tracing::warn!("left out of the diagnosis: {reason}");
    }
    let diagnosis = observed.diagnosed(&campaign);
    if let Some(diagnosis) = diagnosis.as_ref().filter(|_| arguments.write_model) {
        write_model(&campaign, &diagnosis.model)?;
    }
    let exit = if diagnosis.is_some() { Exit::Done } else { Exit::Incomplete };
    if arguments.json {
        out.write_all(report::diagnosis_json(diagnosis.as_ref()).as_bytes())?;
    } else {
        out.write_all(report::diagnosis_text(diagnosis.as_ref()).as_bytes())?;
        if diagnosis.is_none() {
            why_none(out, &results)?;
        }
    }
    Ok(exit)
}

/// Why no run of the campaign could be diagnosed.
fn why_none(out: &mut dyn Write, results: &Results) -> io::Result<()> {
    tables::not_used(out, results)?;
    let left = results.rejected.iter().filter(|one| one.reason.contains(LEFT_ITS_COURSE));
    let of: BTreeSet<&str> = left.map(|one| one.recording.as_str()).collect();
    if of.len() > 1 {
        let n = of.len();
        writeln!(
            out,
            "\nhint: in {n} recordings {LEFT_ITS_COURSE}; where no hand touched the model so\n\
             often, it beats with something: water inside it (drain or block the tank), or a\n\
             clamp that gives way"
        )?;
    }
    Ok(())
}

fn write_model(campaign: &Campaign, model: &ModelFile) -> Result<(), Failure> {
    let path = Campaign::model_path(&campaign.folder);
    let failed = |source| Failure::File { path: path.clone(), source };
    fs::create_dir_all(pipeline::results_folder(campaign)).map_err(failed)?;
    fs::write(&path, model.to_toml()).map_err(failed)
}
