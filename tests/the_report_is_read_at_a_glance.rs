//! The campaign page read by someone in a hurry: damping first, what is trivial folded away.

use std::fs;
use std::path::Path;

use rolltank::report;
use rolltank::results::Results;

use crate::synthetic_results;

const SVG_NAME_SPACE: &str = "xmlns=\"http://www.w3.org/2000/svg\"";

fn written() -> (tempfile::TempDir, Results) {
    let results = synthetic_results::results();
    let folder = tempfile::tempdir().expect("a folder for the report");
    page(&results, folder.path());
    (folder, results)
}

/// The campaign's page, written to `folder`.
fn page(results: &Results, folder: &Path) -> String {
    let campaign = synthetic_results::campaign("OE basin");
    let path = report::write_campaign(&campaign, results, None, folder).expect("a report");
    fs::read_to_string(path).expect("a page")
}

#[test]
fn the_damping_of_each_decay_is_found_at_its_froude_number_with_its_interval() {
    let (folder, results) = written();
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    let first = page.find("<table").expect("a table");
    assert!(page[first..].starts_with("<table id=\"damping-at-speeds\""), "it is the first table");
    let table = page[first..].split("</table>").next().unwrap();
    for run in results.runs.iter().filter(|run| run.identification.forced.is_none()) {
        let link = format!(">{}</a>", run.id);
        let row = table.split("<tr>").find(|row| row.contains(&link)).expect("a row per decay");
        let cells: Vec<_> = row.split("<td").collect();
        assert!(cells[1].contains(&format!(">{:.3}", run.froude)), "{}", cells[1]);
        let b1 = run.identification.damping.b1_per_s;
        let printed = cells[5].split(['>', ' ']).find_map(|word| word.parse::<f64>().ok());
        // Two digits of the standard deviation, four of the mean.
        let rounding = b1.sd.max(1e-3 * b1.mean);
        assert!((printed.expect("b1") - b1.mean).abs() <= rounding, "{}", cells[5]);
        assert!(cells[5].contains('[') && cells[5].contains(']'), "with its interval");
    }
}

#[test]
fn the_damping_figure_is_a_file_that_needs_nothing_beside_it() {
    let (folder, results) = written();
    let svg = fs::read_to_string(folder.path().join("damping_against_froude.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.contains(SVG_NAME_SPACE));
    // A viewer outside a page knows neither its size nor its ground nor its style sheet.
    for needed in ["width=\"720\"", "viewBox=", "fill=\"#ffffff\"", "font-family="] {
        assert!(svg.contains(needed), "the drawing lacks {needed}");
    }
    for foreign in ["href", "url(", "class=", "<style", "<script", "@import"] {
        assert!(!svg.contains(foreign), "the drawing has {foreign}");
    }
    for law in &results.froude_laws {
        assert!(svg.contains(&format!("{}, law", law.condition)));
    }
}

#[test]
fn changeovers_beside_forced_runs_are_folded_behind_real_refusals() {
    let mut results = synthetic_results::results();
    let forced = results.runs.iter().find(|run| run.identification.forced.is_some()).unwrap();
    let mut changeover = results.rejected[0].clone();
    changeover.recording = forced.recording.clone();
    (changeover.start_s, changeover.end_s) = (forced.run.end_s, forced.run.end_s + 1.0);
    changeover.reason = "the excitation changed".to_owned();
    let mut lost = changeover.clone();
    lost.end_s = lost.start_s + 60.0;
    lost.reason = "a minute was lost".to_owned();
    results.rejected.extend([changeover, lost]);
    let folder = tempfile::tempdir().unwrap();
    let page = page(&results, folder.path());
    let part = page.split("id=\"rejected\"").nth(1).unwrap().split("</section>").next().unwrap();
    let (shown, folded) = part.split_once("<details>").expect("changeovers are folded");
    assert!(shown.contains("a minute was lost") && !shown.contains("the excitation changed"));
    assert!(folded.contains("the excitation changed"));
}
