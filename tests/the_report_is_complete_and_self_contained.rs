//! The pages: whole, readable without a network, true to the results.

use std::fs;
use std::path::Path;

use devices::Quantity;
use devices::channel::{Brought, Counts};
use rolltank::inverse::estimate::Estimate;
use rolltank::report::{self, ReportError};
use rolltank::results::Results;
use serde_json::Value;

use crate::synthetic_results;

const SVG_NAME_SPACE: &str = "xmlns=\"http://www.w3.org/2000/svg\"";

/// The page of the run with this id, after a whole report was written.
fn run_page(folder: &Path, id: &str) -> String {
    fs::read_to_string(folder.join(format!("run-{id}.html"))).expect("a page per run")
}

fn written(name: &str) -> (tempfile::TempDir, Results) {
    let campaign = synthetic_results::campaign(name);
    let results = synthetic_results::results();
    let folder = tempfile::tempdir().expect("a folder for the report");
    report::write_all(&campaign, &results, folder.path()).expect("a report");
    (folder, results)
}

/// The values of an attribute, in order.
fn attributes<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let opening = format!(" {name}=\"");
    page.split(&opening).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// The text of an element: its markup taken away.
fn text(html: &str) -> String {
    let mut text = String::new();
    let mut inside = false;
    for letter in html.chars() {
        match letter {
            '<' => inside = true,
            '>' => inside = false,
            _ if !inside => text.push(letter),
            _ => {}
        }
    }
    text
}

#[test]
fn every_page_opens_without_a_network_without_scripts_and_links_only_to_pages_beside_it() {
    let (folder, _) = written("OE basin");
    for entry in fs::read_dir(folder.path()).unwrap() {
        let path = entry.unwrap().path();
        // The name space of SVG is an address that nothing opens.
        let page = fs::read_to_string(&path).unwrap().replace(SVG_NAME_SPACE, "");
        for foreign in ["http:", "https:", "src=", "url(", "@import", "<script", "<link"] {
            assert!(!page.contains(foreign), "{} has {foreign}", path.display());
        }
        for link in attributes(&page, "href") {
            assert!(folder.path().join(link).is_file(), "{} leads to {link}", path.display());
        }
    }
}

#[test]
fn a_run_page_shows_every_part_that_its_run_has() {
    let (folder, results) = written("OE basin");
    let of_every_run = [
        "facts",
        "record",
        "roll",
        "observable",
        "least-squares",
        "moment",
        "scatter",
        "coefficients",
        "equivalent-damping",
        "equivalent-damping-table",
        "resimulation",
        "conventions",
        "symbols",
    ];
    for run in &results.runs {
        let page = run_page(folder.path(), &run.id);
        let ids = attributes(&page, "id");
        let shown = |id: &str| ids.contains(&id);
        for id in of_every_run {
            assert!(shown(id), "run {} lacks {id}", run.id);
        }
        assert_eq!(shown("forced"), run.identification.forced.is_some(), "run {}", run.id);
        assert_eq!(shown("natural-frequency"), run.identification.forced.is_none());
        assert_eq!(shown("chain"), run.identification.chain.is_some(), "run {}", run.id);
        let remarks = &run.identification.remarks;
        let of_the_model = remarks.iter().filter(|text| text.contains("leaves")).count();
        assert_eq!(shown("law-gaps"), of_the_model > 0, "run {}", run.id);
        assert_eq!(shown("remarks"), remarks.len() > of_the_model, "run {}", run.id);
    }
}

#[test]
fn a_run_page_tells_what_each_instrument_lost_and_says_so_when_that_is_nothing() {
    let campaign = synthetic_results::campaign("OE basin");
    let mut results = synthetic_results::results();
    let roll = Counts { received: 1993, lost: 5, repeated: 2, over_range: 1, damaged: 4 };
    let speed = Counts { received: 200, ..Counts::default() };
    let of = |quantity, counts| Brought { quantity, counts, bound_s: Some(2.5e-4) };
    results.runs[0].brought = vec![of(Quantity::Roll, roll), of(Quantity::Speed, speed)];
    results.runs[1].brought = vec![of(Quantity::Speed, speed)];
    results.runs[2].brought = Vec::new();
    let folder = tempfile::tempdir().expect("a folder for the report");
    report::write_all(&campaign, &results, folder.path()).expect("a report");
    let told = |run: usize| {
        let page = run_page(folder.path(), &results.runs[run].id);
        let part = page.split("id=\"counted\"").nth(1)?;
        Some(text(&part.split("</section>").next()?.replace("</td>", " ")))
    };
    let lost = told(0).expect("a part of its own");
    assert!(lost.contains("roll 1993 5 2 1 4 0.25 speed 200 0 0 0 0 0.25"), "{lost}");
    assert!(!lost.contains("Every sample came"), "{lost}");
    assert!(told(1).is_some_and(|told| told.contains("Every sample came")));
    assert_eq!(told(2), None, "nobody counted");
}

#[test]
fn the_campaign_page_shows_every_part() {
    let (folder, results) = written("OE basin");
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    let ids = attributes(&page, "id");
    for id in [
        "particulars-table",
        "conditions-table",
        "damping-at-speeds",
        "law-gaps",
        "damping",
        "froude-law-table",
        "nonlinear-at-speeds-table",
        "equivalent-damping",
        "runs-table",
        "inertia-1",
        "peak-frequency-1",
        "peak-froude-2",
        "forced-damping-2",
        "forced-runs-table",
        "rejected-table",
        "notes",
        "conventions",
        "symbol-table",
    ] {
        assert!(ids.contains(&id), "the page lacks {id}");
    }
    for stretch in &results.rejected {
        assert!(page.contains(&stretch.reason));
    }
}

#[test]
fn every_drawing_tells_a_screen_reader_what_it_shows_under_ids_used_once() {
    let (folder, results) = written("OE basin");
    let page = run_page(folder.path(), &results.runs[0].id);
    let drawings = page.matches("<svg").count();
    assert!(drawings >= 8);
    assert_eq!(page.matches("role=\"img\"").count(), drawings);
    let ids = attributes(&page, "id");
    for labelled in attributes(&page, "aria-labelledby") {
        assert!(labelled.split(' ').all(|id| ids.contains(&id)), "{labelled}");
    }
    let mut once = ids.clone();
    once.sort_unstable();
    once.dedup();
    assert_eq!(once.len(), ids.len());
}

#[test]
fn every_number_of_the_run_table_is_the_number_of_the_json_rounded() {
    let campaign = synthetic_results::campaign("OE basin");
    let results = synthetic_results::results();
    let json: Value =
        serde_json::from_str(&report::identification_json(&campaign, &results)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = report::write_campaign(&campaign, &results, None, folder.path()).unwrap();
    let page = fs::read_to_string(path).unwrap();
    let table = page.split("id=\"runs-table\"").nth(1).unwrap().split("</table>").next().unwrap();
    let rows: Vec<_> = table.split("<tbody>").nth(1).unwrap().split("<tr>").skip(1).collect();
    let runs = json["runs"].as_array().unwrap();
    assert_eq!(rows.len(), runs.len());
    for (row, run) in rows.iter().zip(runs) {
        let cells: Vec<_> =
            row.split("<td").skip(1).map(|cell| text(&format!("<td{cell}"))).collect();
        assert_eq!(cells[0], run["id"].as_str().unwrap());
        assert_eq!(cells[1], run["kind"].as_str().unwrap());
        assert_rounded(&cells[3], &[&run["froude"]]);
        let at_five = run["equivalent_damping_per_s"].as_array().unwrap().iter();
        let at_five = at_five.clone().find(|at| at["amplitude_deg"] == 5.0).unwrap();
        let estimates =
            [&run["natural_frequency_rad_s"], &run["b1_per_s"], &run["b3_s"], &at_five["value"]];
        for (cell, estimate) in cells[4..8].iter().zip(estimates) {
            assert_rounded(cell, &[&estimate["mean"], &estimate["lo95"], &estimate["hi95"]]);
        }
        assert_rounded(&cells[8], &[&run["resimulation_rmse_deg"]]);
    }
}

/// Every number printed in `cell` is the exact one to half a unit of its last printed digit.
pub(crate) fn assert_rounded(cell: &str, exact: &[&Value]) {
    let plain = cell.replace('\u{2212}', "-");
    let printed: Vec<_> =
        plain.split([' ', ',', '[', ']']).filter(|word| !word.is_empty()).collect();
    assert_eq!(printed.len(), exact.len(), "{cell}");
    for (printed, exact) in printed.iter().zip(exact) {
        let decimals = printed.split('.').nth(1).map_or(0, str::len);
        let half_a_digit = 0.5 * 10_f64.powi(-(decimals as i32));
        let difference = printed.parse::<f64>().expect("a number") - exact.as_f64().expect("known");
        // The last bit of the exact number may fall on either side of a tie.
        assert!(difference.abs() <= half_a_digit * (1.0 + 1e-9), "{printed} for {exact}");
    }
}

#[test]
fn names_from_the_campaign_file_are_text_on_the_page_whatever_they_contain() {
    let name = "<b>&\"</b>";
    let mut campaign = synthetic_results::campaign(name);
    let mut results = synthetic_results::results();
    for recording in &mut campaign.recordings {
        recording.condition = name.to_owned();
    }
    for run in &mut results.runs {
        run.condition = name.to_owned();
        run.identification.remarks = vec![name.to_owned()];
    }
    results.rejected[0].reason = name.to_owned();
    let folder = tempfile::tempdir().unwrap();
    report::write_all(&campaign, &results, folder.path()).unwrap();
    let (first, index) = (format!("run-{}.html", results.runs[0].id), "index.html".to_owned());
    for file in [first, index] {
        let page = fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(page.contains("&lt;b&gt;&amp;"), "the name is shown");
        // The caption of every figure has a <b> of its own, but none holds the name's ampersand.
        assert!(!page.contains("<b>&"), "the name is not markup");
    }
}

#[test]
fn a_long_fast_record_makes_a_page_below_one_and_a_half_megabytes() {
    let campaign = synthetic_results::campaign("OE basin");
    let mut results = synthetic_results::results();
    let run = &mut results.runs[3];
    // One minute at 5 kHz, the fastest rate the method is meant for.
    let time_s: Vec<f64> = (0..300_000).map(|k| 20.0 + f64::from(k) / 5000.0).collect();
    let wave: Vec<f64> =
        time_s.iter().map(|t| 0.1 * (7.0 * t).sin() + 1e-3 * (9e3 * t).sin()).collect();
    let moment = &mut run.identification.moment;
    for series in [
        &mut moment.mean_per_s2,
        &mut moment.sd_per_s2,
        &mut moment.lo95_per_s2,
        &mut moment.hi95_per_s2,
        &mut moment.roll_rad,
        &mut moment.roll_rate_rad_per_s,
        &mut moment.observable_rad,
        &mut run.identification.least_squares_per_s2,
        &mut run.identification.resimulation.measured_rad,
        &mut run.identification.resimulation.simulated_rad,
        &mut run.run.roll.value,
    ] {
        series.clone_from(&wave);
    }
    moment.time_s.clone_from(&time_s);
    run.identification.resimulation.time_s.clone_from(&time_s);
    run.run.roll.time_s = time_s;
    let folder = tempfile::tempdir().unwrap();
    let overview = Some(&results.overviews[0]);
    let path = report::write_run(&campaign, &results.runs[3], overview, folder.path()).unwrap();
    let size = fs::metadata(path).unwrap().len();
    assert!(size < 1_500_000, "{size} bytes");
}

#[test]
fn numbers_that_are_not_known_are_dashes_and_never_nan() {
    let campaign = synthetic_results::campaign("OE basin");
    let mut results = synthetic_results::results();
    let unknown = Estimate { mean: f64::NAN, sd: f64::NAN, lo95: f64::NAN, hi95: f64::INFINITY };
    for run in &mut results.runs {
        run.identification.damping.b1_per_s = unknown;
        run.identification.natural_frequency_rad_s = unknown;
        run.identification.resimulation.rmse_rad = f64::NAN;
        run.identification.moment.mean_per_s2.fill(f64::NAN);
    }
    let folder = tempfile::tempdir().unwrap();
    report::write_all(&campaign, &results, folder.path()).unwrap();
    for entry in fs::read_dir(folder.path()).unwrap() {
        let page = fs::read_to_string(entry.unwrap().path()).unwrap();
        let page = text(&page);
        let not_a_number =
            page.split(|c: char| !c.is_alphanumeric()).find(|word| matches!(*word, "NaN" | "inf"));
        assert_eq!(not_a_number, None, "{:?}", page.find("NaN").map(|at| &page[at - 60..at + 30]));
    }
}

#[test]
fn a_campaign_without_runs_says_so_with_its_reasons() {
    let campaign = synthetic_results::campaign("OE basin");
    let rejected = synthetic_results::results().rejected;
    let results = Results { rejected, ..Results::default() };
    let folder = tempfile::tempdir().unwrap();
    let path = report::write_campaign(&campaign, &results, None, folder.path()).unwrap();
    let page = fs::read_to_string(path).unwrap();
    assert!(page.contains("No run was identified"));
    assert!(page.contains(&results.rejected[0].reason));
}

#[test]
fn a_recording_that_gave_no_run_is_drawn_with_what_was_rejected() {
    let campaign = synthetic_results::campaign("OE basin");
    let mut results = synthetic_results::results();
    let barren = results.overviews[2].recording.clone();
    results.runs.retain(|run| run.recording != barren);
    let folder = tempfile::tempdir().unwrap();
    let path = report::write_campaign(&campaign, &results, None, folder.path()).unwrap();
    let page = fs::read_to_string(path).unwrap();
    let drawn = page.split("id=\"recordings\"").nth(1).unwrap();
    assert!(drawn.contains(&barren));
}

#[test]
fn a_run_name_that_leads_out_of_the_folder_is_refused_before_anything_is_written() {
    let campaign = synthetic_results::campaign("OE basin");
    let mut results = synthetic_results::results();
    results.runs[0].id = "../../escape".to_owned();
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("a").join("b");
    let error = report::write_run(&campaign, &results.runs[0], None, &inner).unwrap_err();
    assert!(matches!(&error, ReportError::RunId { id } if id == "../../escape"));
    assert!(error.to_string().contains("hint:"));
    assert!(report::write_campaign(&campaign, &results, None, &inner).is_err());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn only_finished_files_are_left_in_the_folder() {
    let (folder, results) = written("OE basin");
    let mut names: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let mut expected: Vec<_> =
        results.runs.iter().map(|run| format!("run-{}.html", run.id)).collect();
    expected.push("index.html".to_owned());
    expected.push("damping_against_froude.svg".to_owned());
    expected.sort();
    assert_eq!(names, expected);
}

#[test]
fn a_folder_that_cannot_be_written_is_named_in_the_error() {
    let campaign = synthetic_results::campaign("OE basin");
    let folder = tempfile::tempdir().unwrap();
    let taken = folder.path().join("results");
    fs::write(&taken, "a file where the folder should be").unwrap();
    let error = report::write_campaign(&campaign, &Results::default(), None, &taken).unwrap_err();
    let message = error.to_string();
    assert!(message.contains("index.html") && message.contains("hint:"), "{message}");
}
