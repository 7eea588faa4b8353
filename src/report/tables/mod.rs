//! The results as tables, one unit per column, in whatever file other programs read.

mod contents;
mod csv_file;
mod moment_history;
mod parquet_file;
mod thrift;

use std::path::{Path, PathBuf};

use super::{ReportError, whole_file};
use crate::campaign::Campaign;
use crate::results::Results;

/// Files that tables are written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated values.
    Csv,
    /// Apache Parquet.
    Parquet,
}

/// One table: its name, its columns, its rows.
struct Table {
    name: &'static str,
    headers: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

/// What stands in a cell; every cell of a column is of one kind.
enum Cell {
    Text(String),
    /// Not known where it is not finite.
    Number(f64),
    Flag(bool),
}

/// Writes the tables of a report to `dir`; returns the paths.
///
/// Numbers have as many digits as they need to be read back exactly; what is not known is empty.
pub fn csv_tables(
    campaign: &Campaign,
    results: &Results,
    dir: &Path,
) -> Result<Vec<PathBuf>, ReportError> {
    contents::all(campaign, results)
        .iter()
        .map(|table| written(table, TableFormat::Csv, dir))
        .collect()
}

/// Writes every table, the moment histories included, to `dir`; returns the paths.
pub fn export_tables(
    campaign: &Campaign,
    results: &Results,
    format: TableFormat,
    dir: &Path,
) -> Result<Vec<PathBuf>, ReportError> {
    let mut all = contents::all(campaign, results);
    all.push(moment_history::table(results));
    all.iter().map(|table| written(table, format, dir)).collect()
}

fn written(table: &Table, format: TableFormat, dir: &Path) -> Result<PathBuf, ReportError> {
    let (bytes, ending) = match format {
        TableFormat::Csv => (csv_file::bytes(table), "csv"),
        TableFormat::Parquet => (Ok(parquet_file::bytes(table)), "parquet"),
    };
    let name = table.name;
    let bytes = bytes.map_err(|source| ReportError::Table { name, source })?;
    whole_file::write(dir, &format!("{name}.{ending}"), &bytes)
}
