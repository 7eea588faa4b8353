//! The files of a report: pages, tables, JSON and catalogue, all in one folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::campaign::Campaign;
use crate::catalogue::{self, CatalogueError};
use crate::report::{self, ReportError};
use crate::results::{IdentifiedRun, Overview, Results};

/// The campaign's page in a report folder.
pub const REPORT_PAGE: &str = "index.html";

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
/// In the campaign's own results folder, pages of runs that are no more are removed.
pub fn write_results(
    campaign: &Campaign,
    results: &Results,
    dir: &Path,
) -> Result<PathBuf, WriteError> {
    report::csv_tables(campaign, results, dir)?;
    write_text(dir, "identification.json", &report::identification_json(campaign, results))?;
    write_text(dir, "identification.schema.json", report::IDENTIFICATION_SCHEMA)?;
    catalogue::write(&dir.join(CATALOGUE), campaign, results)?;
    if dir == results_folder(campaign) {
        remove_stale_pages(results, dir)?;
    }
    Ok(report::write_campaign(campaign, results, dir)?)
}

fn write_text(dir: &Path, name: &str, text: &str) -> Result<(), WriteError> {
    let path = dir.join(name);
    fs::write(&path, text).map_err(|source| WriteError::File { path, source })
}

/// Removes the pages that an earlier replay wrote for runs that are no more.
fn remove_stale_pages(results: &Results, dir: &Path) -> Result<(), WriteError> {
    let at = |path: &Path| {
        let path = path.to_owned();
        |source| WriteError::File { path, source }
    };
    for entry in fs::read_dir(dir).map_err(at(dir))? {
        let path = entry.map_err(at(dir))?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let id = name.strip_prefix("run-").and_then(|name| name.strip_suffix(".html"));
        if id.is_some_and(|id| !results.runs.iter().any(|run| run.id == id)) {
            fs::remove_file(&path).map_err(at(&path))?;
        }
    }
    Ok(())
}
