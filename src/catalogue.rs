//! The run catalogue beside the recordings, rebuilt from them at any time.

use std::fs;
use std::path::{Path, PathBuf};

use rusqlite::{Connection, Transaction, params};

use crate::campaign::Campaign;
use crate::inverse::estimate::Estimate;
use crate::results::Results;

/// Tables of the catalogue; units are in the column names, the 95 % interval is `lo95` to `hi95`.
const TABLES: &str = "
CREATE TABLE recording (
    name TEXT PRIMARY KEY, condition TEXT NOT NULL, declared_speed_m_s REAL, notes TEXT NOT NULL
) STRICT;
CREATE TABLE run (
    id TEXT PRIMARY KEY, recording TEXT NOT NULL, kind TEXT NOT NULL, condition TEXT NOT NULL,
    start_s REAL, end_s REAL, speed_m_s REAL, froude REAL,
    natural_frequency_rad_s REAL, natural_frequency_sd REAL,
    natural_frequency_lo95 REAL, natural_frequency_hi95 REAL,
    b1_per_s REAL, b1_sd REAL, b1_lo95 REAL, b1_hi95 REAL,
    b3_s REAL, b3_sd REAL, b3_lo95 REAL, b3_hi95 REAL,
    b1_b3_correlation REAL, resimulation_rmse_rad REAL,
    inertia_kg_m2 REAL, inertia_sd REAL, inertia_lo95 REAL, inertia_hi95 REAL
) STRICT;
CREATE TABLE rejection (
    recording TEXT NOT NULL, start_s REAL, end_s REAL, reason TEXT NOT NULL
) STRICT;
CREATE TABLE equivalent_damping (
    run TEXT NOT NULL REFERENCES run (id),
    amplitude_deg REAL NOT NULL, extrapolated INTEGER NOT NULL,
    fitted_per_s REAL, fitted_sd REAL, fitted_lo95 REAL, fitted_hi95 REAL,
    local_per_s REAL, local_sd REAL, local_lo95 REAL, local_hi95 REAL
) STRICT;
CREATE TABLE froude_law (
    condition TEXT PRIMARY KEY,
    b0_per_s REAL, b0_sd REAL, b0_lo95 REAL, b0_hi95 REAL,
    kappa REAL, kappa_sd REAL, kappa_lo95 REAL, kappa_hi95 REAL,
    b3_s REAL, b3_sd REAL, b3_lo95 REAL, b3_hi95 REAL,
    scatter_per_s REAL, scatter_sd REAL, scatter_lo95 REAL, scatter_hi95 REAL
) STRICT;
";

/// Why the catalogue could not be written.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueError {
    /// The database refused.
    #[error("catalogue \"{}\": {source}", path.display())]
    Database {
        /// The catalogue.
        path: PathBuf,
        /// What the database said.
        source: rusqlite::Error,
    },
    /// The disk refused the file.
    #[error(
        "catalogue \"{}\": {source}\n\
         hint: check that the results folder can be written and that the disk is not full",
        path.display()
    )]
    File {
        /// The catalogue.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// Writes the whole catalogue to `path`; a reader sees the old one or the new one, never half.
pub fn write(path: &Path, campaign: &Campaign, results: &Results) -> Result<(), CatalogueError> {
    let file = |source| CatalogueError::File { path: path.to_owned(), source };
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(path.file_name().unwrap_or(path.as_os_str()));
    hidden.push(".unfinished");
    let unfinished = folder.join(hidden);
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(folder).map_err(file)?;
    }
    // What an earlier attempt left behind would be added to, not replaced.
    if unfinished.exists() {
        fs::remove_file(&unfinished).map_err(file)?;
    }
    fill(&unfinished, campaign, results)
        .map_err(|source| CatalogueError::Database { path: path.to_owned(), source })?;
    fs::rename(&unfinished, path).map_err(file)
}

fn fill(path: &Path, campaign: &Campaign, results: &Results) -> Result<(), rusqlite::Error> {
    let mut database = Connection::open(path)?;
    // The file is new and is renamed when whole, so a journal beside it has nothing to protect.
    database.pragma_update(None, "journal_mode", "MEMORY")?;
    let transaction = database.transaction()?;
    transaction.execute_batch(TABLES)?;
    recordings(&transaction, campaign, results)?;
    runs(&transaction, results)?;
    rejections(&transaction, results)?;
    equivalent_damping(&transaction, results)?;
    froude_laws(&transaction, results)?;
    transaction.commit()?;
    database.close().map_err(|(_, error)| error)
}

fn recordings(
    database: &Transaction,
    campaign: &Campaign,
    results: &Results,
) -> Result<(), rusqlite::Error> {
    let mut insert = database.prepare("INSERT INTO recording VALUES (?1, ?2, ?3, ?4)")?;
    for recording in &campaign.recordings {
        let overview = results.overviews.iter().find(|seen| seen.recording == recording.name);
        let notes = overview.map_or(String::new(), |overview| overview.notes.join("\n"));
        let row = params![recording.name, recording.condition, recording.speed_m_s, notes];
        insert.execute(row)?;
    }
    Ok(())
}

fn runs(database: &Transaction, results: &Results) -> Result<(), rusqlite::Error> {
    let mut insert = database.prepare(&insert_into("run", 26))?;
    for run in &results.runs {
        let identification = &run.identification;
        let [w, w_sd, w_lo, w_hi] = columns(Some(identification.natural_frequency_rad_s));
        let [b1, b1_sd, b1_lo, b1_hi] = columns(Some(identification.damping.b1_per_s));
        let [b3, b3_sd, b3_lo, b3_hi] = columns(Some(identification.damping.b3_s));
        let [i, i_sd, i_lo, i_hi] = columns(identification.inertia_kg_m2);
        insert.execute(params![
            run.id,
            run.recording,
            run.run.kind.name(),
            run.condition,
            known(run.run.start_s),
            known(run.run.end_s),
            known(run.speed_m_s),
            known(run.froude),
            w,
            w_sd,
            w_lo,
            w_hi,
            b1,
            b1_sd,
            b1_lo,
            b1_hi,
            b3,
            b3_sd,
            b3_lo,
            b3_hi,
            known(identification.damping.correlation),
            known(identification.resimulation.rmse_rad),
            i,
            i_sd,
            i_lo,
            i_hi,
        ])?;
    }
    Ok(())
}

fn rejections(database: &Transaction, results: &Results) -> Result<(), rusqlite::Error> {
    let mut insert = database.prepare(&insert_into("rejection", 4))?;
    for stretch in &results.rejected {
        let (start_s, end_s) = (known(stretch.start_s), known(stretch.end_s));
        insert.execute(params![stretch.recording, start_s, end_s, stretch.reason])?;
    }
    Ok(())
}

fn equivalent_damping(database: &Transaction, results: &Results) -> Result<(), rusqlite::Error> {
    let mut insert = database.prepare(&insert_into("equivalent_damping", 11))?;
    for run in &results.runs {
        for at in &run.identification.equivalent_damping {
            let [b, sd, lo, hi] = columns(Some(at.fitted_per_s));
            let [local, local_sd, local_lo, local_hi] = columns(at.local_per_s);
            insert.execute(params![
                run.id,
                at.amplitude_deg,
                at.extrapolated,
                b,
                sd,
                lo,
                hi,
                local,
                local_sd,
                local_lo,
                local_hi
            ])?;
        }
    }
    Ok(())
}

fn froude_laws(database: &Transaction, results: &Results) -> Result<(), rusqlite::Error> {
    let mut insert = database.prepare(&insert_into("froude_law", 17))?;
    for law in &results.froude_laws {
        let estimates = [law.b0_per_s, law.kappa, law.b3_s, law.scatter_per_s];
        let numbers = estimates.into_iter().flat_map(|estimate| columns(Some(estimate)));
        insert.raw_bind_parameter(1, &law.condition)?;
        for (index, number) in numbers.enumerate() {
            insert.raw_bind_parameter(index + 2, number)?;
        }
        insert.raw_execute()?;
    }
    Ok(())
}

fn insert_into(table: &str, n_columns: usize) -> String {
    let places: Vec<_> = (1..=n_columns).map(|k| format!("?{k}")).collect();
    format!("INSERT INTO {table} VALUES ({})", places.join(", "))
}

/// Mean, standard deviation and interval ends, null where not known.
fn columns(estimate: Option<Estimate>) -> [Option<f64>; 4] {
    estimate.map_or([None; 4], |estimate| {
        [estimate.mean, estimate.sd, estimate.lo95, estimate.hi95].map(known)
    })
}

fn known(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
