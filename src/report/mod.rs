//! What the customer gets: pages with figures, tables, the JSON contract.

mod appendix;
mod book;
mod campaign_page;
mod damping_table;
mod diagnosis_json;
mod diagnosis_page;
mod diagnosis_text;
mod document;
mod field_units;
pub(crate) mod figure;
mod gates;
mod glossary;
mod json;
mod json_beliefs;
mod judged_run;
mod live_page;
mod notation;
mod number;
mod provisional;
mod remark;
mod run_page;
mod tables;
mod whole_file;

use std::path::{Path, PathBuf};

pub use appendix::{Appendix, AttachedInstrument, ChannelCalibration, RecordedFile};
pub use book::{Extent, book};
pub use damping_table::damping_table;
pub use diagnosis_json::{DIAGNOSIS_SCHEMA, diagnosis_json};
pub use diagnosis_text::diagnosis_text;
pub use json::{IDENTIFICATION_NAME, IDENTIFICATION_SCHEMA, identification_json};
pub use provisional::{PROVISIONAL_FILE, PROVISIONAL_ID, provisional_json, provisional_words};
pub use tables::{TableFormat, csv_tables, export_tables};
pub use whole_file::write as write_whole;

use crate::campaign::Campaign;
use crate::diagnosis::Diagnosis;
use crate::results::{IdentifiedRun, Overview, RejectedStretch, Results};

/// The style sheet of every page of the report.
pub const STYLE: &str = document::STYLE;

/// A page of the report with its style sheet beside it, under an address.
pub fn with_style_beside(page: &str, address: &str) -> String {
    document::with_style_beside(page, address)
}

/// What was learnt so far as parts of the live page: the name of each and its HTML.
pub fn live_parts(
    campaign: &Campaign,
    results: &Results,
    diagnosis: Option<&Diagnosis>,
) -> Vec<(&'static str, String)> {
    live_page::parts(campaign, results, diagnosis)
}

/// File name of the page of a run.
///
/// # Errors
/// [`ReportError::RunId`] when it would lead out of the folder.
pub fn run_file_name(id: &str) -> Result<String, ReportError> {
    document::run_file_name(id)
}

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The disk refused a file.
    #[error(
        "report file \"{}\": {source}\n\
         hint: check that the results folder can be written and that the disk is not full",
        path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A page that was written cannot be read again.
    #[error("report file \"{}\": {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A run's name would lead out of the report folder.
    #[error(
        "run \"{id}\" cannot name a report file\n\
         hint: a run id has no path separator, is not empty and does not begin with a dot"
    )]
    RunId {
        /// The run's id.
        id: String,
    },
    /// A table could not be written as CSV.
    #[error("table \"{name}\": {source}")]
    Table {
        /// Name of the table's file.
        name: &'static str,
        /// What the writer said.
        source: csv::Error,
    },
    /// A table could not be written as Parquet.
    #[error("table \"{name}\": {source}")]
    Parquet {
        /// Name of the table's file.
        name: &'static str,
        /// What the writer said.
        source: parquet::errors::ParquetError,
    },
}

/// Writes the page of one run to `dir` as soon as the run is identified; returns its path.
///
/// Stretches of the recording that were rejected are marked once [`write_all`] knows them.
pub fn write_run(
    campaign: &Campaign,
    run: &IdentifiedRun,
    overview: Option<&Overview>,
    dir: &Path,
) -> Result<PathBuf, ReportError> {
    write_marked_run(campaign, run, overview, &[], dir)
}

/// File name of the figure of damping against Froude number.
const DAMPING_FIGURE: &str = "damping_against_froude.svg";

/// Tells on the page of each run in `dir` whether people have rejected it, and what they noted.
pub fn tell_judgements(results: &Results, dir: &Path) -> Result<(), ReportError> {
    judged_run::tell(results, dir)
}

/// Writes the campaign's page, `index.html`, to `dir`; returns its path.
///
/// With a diagnosis it leads to the page of [`write_diagnosis`], and to the appendix where there is
/// one. Its figure of damping against
/// Froude number is left beside it as a file of its own.
pub fn write_campaign(
    campaign: &Campaign,
    results: &Results,
    diagnosis: Option<&Diagnosis>,
    dir: &Path,
) -> Result<PathBuf, ReportError> {
    for run in &results.runs {
        document::run_file_name(&run.id)?;
    }
    if let Some(figure) = campaign_page::damping_figure(campaign, results) {
        let drawing = figure.file().into_string();
        whole_file::write(dir, DAMPING_FIGURE, drawing.as_bytes())?;
    }
    let has_appendix = dir.join(APPENDIX_PAGE).is_file();
    let page = campaign_page::html(campaign, results, diagnosis, has_appendix);
    whole_file::write(dir, "index.html", page.into_string().as_bytes())
}

/// File name of the page of the diagnosis.
pub const DIAGNOSIS_PAGE: &str = "diagnosis.html";

/// Writes the diagnosis, as a page and as JSON with its schema, to `dir`; returns the page's path.
pub fn write_diagnosis(
    campaign: &Campaign,
    diagnosis: Option<&Diagnosis>,
    dir: &Path,
) -> Result<PathBuf, ReportError> {
    whole_file::write(dir, "diagnosis.json", diagnosis_json(diagnosis).as_bytes())?;
    whole_file::write(dir, "diagnosis.schema.json", DIAGNOSIS_SCHEMA.as_bytes())?;
    let page = diagnosis_page::html(&campaign.name, diagnosis);
    whole_file::write(dir, DIAGNOSIS_PAGE, page.into_string().as_bytes())
}

/// File name of the page of the appendix.
const APPENDIX_PAGE: &str = "appendix.html";

/// Writes the appendix, as a page and as JSON, to `dir`.
pub fn write_appendix(
    campaign: &Campaign,
    appendix: &Appendix,
    dir: &Path,
) -> Result<(), ReportError> {
    whole_file::write(dir, "appendix.json", appendix::json(appendix).as_bytes())?;
    let page = appendix::page(&campaign.name, appendix);
    whole_file::write(dir, APPENDIX_PAGE, page.into_string().as_bytes())?;
    Ok(())
}

/// Writes the page of every run and the campaign's page to `dir`; returns the campaign's page.
pub fn write_all(
    campaign: &Campaign,
    results: &Results,
    dir: &Path,
) -> Result<PathBuf, ReportError> {
    for run in &results.runs {
        let overview = results.overviews.iter().find(|seen| seen.recording == run.recording);
        write_marked_run(campaign, run, overview, &results.rejected, dir)?;
    }
    write_campaign(campaign, results, None, dir)
}

fn write_marked_run(
    campaign: &Campaign,
    run: &IdentifiedRun,
    overview: Option<&Overview>,
    rejected: &[RejectedStretch],
    dir: &Path,
) -> Result<PathBuf, ReportError> {
    let name = document::run_file_name(&run.id)?;
    let page = run_page::html(campaign, run, overview, rejected);
    whole_file::write(dir, &name, page.into_string().as_bytes())
}
