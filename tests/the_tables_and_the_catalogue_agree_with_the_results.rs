//! CSV tables, the catalogue, the table on the terminal: the same numbers as the results.

use std::fs;

use rolltank::catalogue;
use rolltank::report;
use rolltank::results::Results;
use rusqlite::Connection;

use crate::synthetic_results;

fn made() -> (rolltank::campaign::Campaign, Results) {
    let campaign = synthetic_results::campaign("OE basin");
    let results = synthetic_results::results();
    (campaign, results)
}

#[test]
fn the_csv_tables_read_back_exactly_with_a_unit_in_every_number_s_header() {
    let (campaign, results) = made();
    let folder = tempfile::tempdir().unwrap();
    let paths = report::csv_tables(&campaign, &results, folder.path()).unwrap();
    let names: Vec<_> =
        paths.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["runs.csv", "equivalent_damping.csv", "rejected.csv", "froude_law.csv"]);

    let mut table = csv::Reader::from_path(&paths[0]).unwrap();
    let headers = table.headers().unwrap().clone();
    for header in headers.iter().skip(4) {
        assert!(header.ends_with(']'), "{header} has no unit");
    }
    let column = headers.iter().position(|header| header == "b1 mean [1/s]").unwrap();
    let rows: Vec<_> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), results.runs.len());
    for (row, run) in rows.iter().zip(&results.runs) {
        assert_eq!(&row[0], run.id);
        let read: f64 = row[column].parse().unwrap();
        assert_eq!(read.to_bits(), run.identification.damping.b1_per_s.mean.to_bits());
    }

    let n_amplitudes: usize =
        results.runs.iter().map(|run| run.identification.equivalent_damping.len()).sum();
    for (path, n_rows) in
        paths[1..].iter().zip([n_amplitudes, results.rejected.len(), results.froude_laws.len()])
    {
        assert_eq!(csv::Reader::from_path(path).unwrap().records().count(), n_rows);
    }
}

#[test]
fn the_catalogue_holds_every_run_with_its_numbers() {
    let (campaign, results) = made();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results").join("catalogue.sqlite");
    catalogue::write(&path, &campaign, &results).unwrap();
    let database = Connection::open(&path).unwrap();
    let mut select = database
        .prepare("SELECT id, kind, condition, froude, b1_per_s, b3_hi95, inertia_kg_m2 FROM run")
        .unwrap();
    let mut rows = select.query([]).unwrap();
    for run in &results.runs {
        let row = rows.next().unwrap().unwrap();
        let identification = &run.identification;
        assert_eq!(row.get::<_, String>(0).unwrap(), run.id);
        let kind = if identification.forced.is_some() { "forced" } else { "decay" };
        assert_eq!(row.get::<_, String>(1).unwrap(), kind);
        assert_eq!(row.get::<_, String>(2).unwrap(), run.condition);
        let numbers = [3, 4, 5].map(|column| row.get::<_, f64>(column).unwrap().to_bits());
        let damping = identification.damping;
        let expected = [run.froude, damping.b1_per_s.mean, damping.b3_s.hi95].map(f64::to_bits);
        assert_eq!(numbers, expected);
        let inertia = identification.inertia_kg_m2.map(|inertia| inertia.mean);
        assert_eq!(row.get::<_, Option<f64>>(6).unwrap(), inertia);
    }
    assert!(rows.next().unwrap().is_none());
}

#[test]
fn the_catalogue_is_rebuilt_whole_and_never_added_to() {
    let (campaign, mut results) = made();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("catalogue.sqlite");
    // What a crashed attempt left behind must not show through.
    fs::write(folder.path().join(".catalogue.sqlite.unfinished"), "not a database").unwrap();
    catalogue::write(&path, &campaign, &results).unwrap();
    results.runs.truncate(3);
    catalogue::write(&path, &campaign, &results).unwrap();
    let database = Connection::open(&path).unwrap();
    let n_amplitudes: usize =
        results.runs.iter().map(|run| run.identification.equivalent_damping.len()).sum();
    for (table, n_rows) in [
        ("recording", campaign.recordings.len()),
        ("run", 3),
        ("rejection", results.rejected.len()),
        ("equivalent_damping", n_amplitudes),
        ("froude_law", results.froude_laws.len()),
    ] {
        let count: i64 = database
            .query_row(&format!("SELECT count(*) FROM {table}"), [], |row| row.get(0))
            .unwrap();
        assert_eq!(count, n_rows as i64, "{table}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "no half catalogue is left");
}

#[test]
fn the_table_on_the_terminal_is_aligned_within_a_hundred_columns() {
    let (_, mut results) = made();
    for run in &mut results.runs {
        run.condition = format!("{}, with a rather long description of the loading", run.condition);
        // Known to one part in a million: more digits than the terminal has room for.
        run.identification.damping.b1_per_s.sd *= 1e-4;
        run.identification.damping.b3_s.mean *= -1.0;
    }
    let table = report::damping_table(&results);
    for line in table.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
    let rows: Vec<_> = table.lines().filter(|line| line.contains(" decay ")).collect();
    let n_decays = results.runs.iter().filter(|run| run.identification.forced.is_none()).count();
    assert_eq!(rows.len(), n_decays);
    let kinds: Vec<_> = rows.iter().map(|row| row.find("decay")).collect();
    assert!(kinds.windows(2).all(|pair| pair[0] == pair[1]), "the columns are aligned");
}

#[test]
fn the_table_on_the_terminal_sums_up_forced_runs_per_speed_and_prints_the_law() {
    let (_, results) = made();
    let table = report::damping_table(&results);
    assert_eq!(table.matches("4 forced").count(), 10);
    assert!(table.contains("bare hull: b1(Fr) = b0 (1 + kappa Fr^2)"));
    assert!(table.contains("b0 = 0.380 [0.358, 0.402] 1/s, kappa = 11.8 [9.6, 14.0]"));
    assert_eq!(report::damping_table(&Results::default()), "no run was identified\n");
}
