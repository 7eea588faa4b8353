//! `rolltank export`: the results of a campaign as files that other programs read.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::method::Identifying;
use super::{Exit, Failure, replaying, report};
use crate::campaign::{self, Campaign};
use crate::pipeline::WriteError;
use crate::report::{
    IDENTIFICATION_SCHEMA, TableFormat, export_tables, identification_json, write_whole,
};
use crate::results::Results;

/// Write runs, damping, moment histories and rejections as CSV, JSON or Parquet
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Folder that holds campaign.toml
    campaign: PathBuf,
    /// Folder for the files, outside the campaign or below its results/
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Which files, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Format::Csv, Format::Json])]
    format: Vec<Format>,
    #[command(flatten)]
    identifying: Identifying,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    /// Tables as comma-separated values
    Csv,
    /// The whole of the identification in one document, with its schema
    Json,
    /// The same tables as Apache Parquet
    Parquet,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Exit, Failure> {
    let campaign = campaign::read(&arguments.campaign)?;
    report::require_apart(&campaign, &arguments.output)?;
    let replayed = replaying::with_histories(&campaign, arguments.identifying)?;
    for format in &arguments.format {
        let paths = write(*format, &campaign, &replayed.results, &arguments.output)?;
        for path in paths {
            writeln!(out, "{}", path.display())?;
        }
    }
    Ok(replayed.exit)
}

fn write(
    format: Format,
    campaign: &Campaign,
    results: &Results,
    dir: &Path,
) -> Result<Vec<PathBuf>, Failure> {
    let tables =
        |format| Ok(export_tables(campaign, results, format, dir).map_err(WriteError::from)?);
    match format {
        Format::Csv => tables(TableFormat::Csv),
        Format::Parquet => tables(TableFormat::Parquet),
        Format::Json => {
            let document = identification_json(campaign, results);
            let files = [
                ("identification.json", document.as_str()),
                ("identification.schema.json", IDENTIFICATION_SCHEMA),
            ];
            let write = |(name, text): (&str, &str)| {
                Ok(write_whole(dir, name, text.as_bytes()).map_err(WriteError::from)?)
            };
            files.into_iter().map(write).collect()
        }
    }
}
