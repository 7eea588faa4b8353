//! The files of a report: pages, tables, JSON and catalogue, all in one folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::campaign::Campaign;
use crate::catalogue::{self, CatalogueError};
use crate::diagnosis::Diagnosis;
use crate::report::{self, ReportError};
use crate::results::{IdentifiedRun, Overview, Results};

/// The campaign's page in a report folder.
pub const REPORT_PAGE: &str = "index.html";

/// The identification of the JSON contract in a report folder.
const IDENTIFICATION: &str = "identification.json";

/// The run catalogue in a report folder.
const CATALOGUE: &str = "catalogue.sqlite";

/// The only folder that a replay writes to.
const RESULTS_FOLDER: &str = "results";

/// A report that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// A page, table or JSON file.
    #[error(transparent)]
    Report {
        /// Why not.
        #[from]
        source: ReportError,
    },
    /// The catalogue.
    #[error(transparent)]
    Catalogue {
        /// Why not.
        #[from]
        source: CatalogueError,
    },
    /// A file of the report.
    #[error("report file \"{}\"", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// The folder for the results of a campaign, inside its own.
pub fn results_folder(campaign: &Campaign) -> PathBuf {
    campaign.folder.join(RESULTS_FOLDER)
}

/// Writes the page of one run, with the overview of its recording as far as it is known.
pub fn write_run_page(
    campaign: &Campaign,
    run: &IdentifiedRun,
    overview: &Overview,
    dir: &Path,
) -> Result<PathBuf, WriteError> {
    Ok(report::write_run(campaign, run, Some(overview), dir)?)
}

/// Writes everything but the pages of single runs; returns the path of the campaign's page.
///
/// The diagnosis is only led to; [`report::write_diagnosis`] writes it. Pages of runs that are no
/// more are removed: in the campaign's own results folder all of them, in
/// another folder those of the report that was there before.
pub fn write_results(
    campaign: &Campaign,
    results: &Results,
    diagnosis: Option<&Diagnosis>,
    dir: &Path,
) -> Result<PathBuf, WriteError> {
    remove_stale_pages(campaign, results, dir)?;
    report::tell_judgements(results, dir)?;
    report::csv_tables(campaign, results, dir)?;
    write_text(dir, IDENTIFICATION, &report::identification_json(campaign, results))?;
    write_text(dir, "identification.schema.json", report::IDENTIFICATION_SCHEMA)?;
    catalogue::write(&dir.join(CATALOGUE), campaign, results)?;
    Ok(report::write_campaign(campaign, results, diagnosis, dir)?)
}

/// The live page reads the file while it is written anew.
fn write_text(dir: &Path, name: &str, text: &str) -> Result<(), WriteError> {
    report::write_whole(dir, name, text.as_bytes())?;
    Ok(())
}

/// Removes the pages that an earlier replay wrote for runs that are no more.
fn remove_stale_pages(
    campaign: &Campaign,
    results: &Results,
    dir: &Path,
) -> Result<(), WriteError> {
    let at = |path: &Path| {
        let path = path.to_owned();
        |source| WriteError::File { path, source }
    };
    fs::create_dir_all(dir).map_err(at(dir))?;
    let earlier = earlier_ids(dir);
    let all_are_ours = dir == results_folder(campaign);
    for entry in fs::read_dir(dir).map_err(at(dir))? {
        let path = entry.map_err(at(dir))?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let id = name.strip_prefix("run-").and_then(|name| name.strip_suffix(".html"));
        let is_stale = id.is_some_and(|id| {
            (all_are_ours || earlier.iter().any(|earlier| earlier == id))
                && !results.runs.iter().any(|run| run.id == id)
                // What was rejected by hand can be looked at, and taken back.
                && !results.rejected.iter().any(|stretch| stretch.run.as_deref() == Some(id))
        });
        if is_stale {
            fs::remove_file(&path).map_err(at(&path))?;
        }
    }
    Ok(())
}

/// Ids of the runs whose report is in the folder already; none when there is none of ours.
fn earlier_ids(dir: &Path) -> Vec<String> {
    let text = fs::read_to_string(dir.join(IDENTIFICATION)).unwrap_or_default();
    let earlier: Value = serde_json::from_str(&text).unwrap_or_default();
    let runs = earlier["runs"].as_array().into_iter().flatten();
    runs.filter_map(|run| Some(run["id"].as_str()?.to_owned())).collect()
}
