//! What `rolltank export` writes is read by pandas, as docs/python.md says, number for number.

use std::fs;
use std::path::Path;
use std::process::Command;

use rolltank::report::{self, TableFormat};
use rolltank::results::Results;

use crate::campaign_folder::{CampaignFolder, rolltank};
use crate::synthetic_results;

// The same interpreter that reads recordings in the stories of `replay`.
#[path = "../replay/tests/python.rs"]
mod python;

/// Reads every table in both files and compares them bit by bit; null is null.
const COMPARE: &str = r#"
import sys
from pathlib import Path
import pandas as pd

kinds = set()
names = sorted(path.stem for path in Path(sys.argv[1]).glob("*.csv"))
for name in names:
    text = pd.read_csv(f"{sys.argv[1]}/{name}.csv", float_precision="round_trip")
    table = pd.read_parquet(f"{sys.argv[1]}/{name}.parquet")
    assert list(text.columns) == list(table.columns), name
    for column in text:
        kinds.add(str(table[column].dtype))
        if len(text) == 0 or text[column].isna().all():
            assert len(table) == len(text) and table[column].isna().all(), (name, column)
        else:
            found = table[column]
            wanted = text[column].astype(found.dtype)
            pd.testing.assert_series_equal(wanted, found, check_exact=True)
    print(name, len(table))
assert kinds == {"object", "float64", "bool"}, kinds
"#;

/// Arrow's threads may outlive the interpreter and end it by a signal when all was said.
const LEAVE: &str = "\nimport os\nsys.stdout.flush()\nos._exit(0)\n";

fn run(python: &Path, arguments: &[&str], folder: &Path) -> String {
    let output = Command::new(python).args(arguments).current_dir(folder).output();
    let output = output.expect("Python runs");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn parquet_and_csv_hold_the_same_numbers_to_the_bit() {
    let Some(python) = python::python() else { return };
    let campaign = synthetic_results::campaign("OE basin");
    let mut results = synthetic_results::results();
    results.runs[1].identification.damping.b3_s.mean = f64::NAN;
    "Fähre, \"leer\"\nzweite Zeile".clone_into(&mut results.rejected[0].reason);
    let folder = tempfile::tempdir().unwrap();
    for format in [TableFormat::Csv, TableFormat::Parquet] {
        report::export_tables(&campaign, &results, format, folder.path()).unwrap();
    }
    let told = run(python, &["-c", &format!("{COMPARE}{LEAVE}"), "."], folder.path());
    let n_instants: usize =
        results.runs.iter().map(|run| run.identification.moment.time_s.len()).sum();
    assert!(n_instants > 10_000);
    assert!(told.contains(&format!("moment_history {n_instants}\n")), "{told}");
    assert!(told.contains(&format!("runs {}\n", results.runs.len())), "{told}");
}

#[test]
fn tables_without_rows_are_read_too() {
    let Some(python) = python::python() else { return };
    let campaign = synthetic_results::campaign("OE basin");
    let folder = tempfile::tempdir().unwrap();
    for format in [TableFormat::Csv, TableFormat::Parquet] {
        report::export_tables(&campaign, &Results::default(), format, folder.path()).unwrap();
    }
    let lenient = COMPARE.split("assert kinds").next().unwrap();
    assert!(
        run(python, &["-c", &format!("{lenient}{LEAVE}"), "."], folder.path())
            .contains("froude_law 0\n")
    );
}

#[test]
fn the_documented_snippet_runs_on_what_the_documented_commands_wrote() {
    let Some(python) = python::python() else { return };
    let text = include_str!("../docs/python.md");
    let block = |language: &str| {
        let opening = format!("```{language}\n");
        text.split(&opening).nth(1).and_then(|rest| rest.split("```").next()).expect("a block")
    };
    let folder = CampaignFolder::new();
    for line in block("sh").lines() {
        let line = line.replace("CAMPAIGN", ".").replace("-o export", "-o results/export");
        let arguments: Vec<&str> = line.split_whitespace().skip(1).collect();
        let told = rolltank(folder.path(), &arguments);
        assert_eq!(told.exit, 0, "{line}: {}", told.err);
    }
    fs::write(folder.path().join("results/snippet.py"), block("python")).unwrap();
    let told = run(python, &["snippet.py"], &folder.path().join("results"));
    let export = folder.path().join("results/export");
    let document = fs::read_to_string(export.join("identification.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    let id = document["runs"][0]["id"].as_str().unwrap();
    assert!(told.contains(&format!("{id} misses [")), "{told}");
    assert!(told.contains("pass_01.mcap") && told.contains("bare hull"), "{told}");
}
