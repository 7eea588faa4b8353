//! What was learnt goes to the board: parts of the page, files of the report, runs to be judged.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::diagnosing::Diagnosed;
use crate::campaign::Campaign;
use crate::judgement::Place;
use crate::page::{Board, Shown};
use crate::pipeline;
use crate::report;
use crate::results::Results;

/// Files of a report that a page may ask for, beside those of the runs.
const FILES: [&str; 13] = [
    "index.html",
    "diagnosis.html",
    "diagnosis.json",
    "diagnosis.schema.json",
    "identification.json",
    "identification.schema.json",
    "damping_against_froude.svg",
    "runs.csv",
    "equivalent_damping.csv",
    "rejected.csv",
    "froude_law.csv",
    // While a run is under way.
    "run-provisional.html",
    "provisional.json",
];

/// Shows results that nobody has judged yet, as they are by what people have judged; returns those.
pub(super) fn show(
    campaign: &Campaign,
    results: Results,
    diagnosis: Option<&Diagnosed>,
    board: &Board,
) -> Results {
    let results = pipeline::judged(results, &board.judgements());
    let diagnosis = diagnosis.map(AsRef::as_ref);
    board.show(Shown {
        number: 0,
        parts: report::live_parts(campaign, &results, diagnosis),
        files: files(campaign, &results),
        runs: runs(&results),
    });
    results
}

fn files(campaign: &Campaign, results: &Results) -> BTreeMap<String, PathBuf> {
    let dir = pipeline::results_folder(campaign);
    let by_hand = results.rejected.iter().filter_map(|stretch| stretch.run.as_deref());
    let ids = results.runs.iter().map(|run| run.id.as_str()).chain(by_hand);
    let pages = ids.filter_map(|id| report::run_file_name(id).ok());
    let names = FILES.into_iter().map(str::to_owned).chain(pages);
    names.map(|name| (name.clone(), dir.join(name))).collect()
}

/// Where each run lies, those that were rejected by hand included.
fn runs(results: &Results) -> BTreeMap<String, Place> {
    let place = |recording: &str, start_s: f64, end_s: f64| Place {
        recording: recording.to_owned(),
        start_s,
        end_s,
    };
    let found = results
        .runs
        .iter()
        .map(|run| (run.id.clone(), place(&run.recording, run.run.start_s, run.run.end_s)));
    let by_hand = results.rejected.iter().filter_map(|stretch| {
        let id = stretch.run.clone()?;
        Some((id, place(&stretch.recording, stretch.start_s, stretch.end_s)))
    });
    found.chain(by_hand).collect()
}
