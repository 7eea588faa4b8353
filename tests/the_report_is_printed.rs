//! The report on paper: the same numbers, nothing beyond the margins, nothing over anything else.

use std::fs;
use std::path::Path;
use std::process::Command;

use rolltank::pipeline;
use rolltank::report::{self, Extent};
use rolltank::results::Results;
use serde_json::Value;

use crate::campaign_folder::{CampaignFolder, rolltank};
use crate::chromium;
use crate::debian;
use crate::kvlcc2_is_identified_as_published;
use crate::synthetic_results;
use crate::the_report_is_complete_and_self_contained::assert_rounded;

/// The text of a PDF by one of the modes of `pdftotext`.
fn text(pdf: &Path, mode: &str) -> String {
    let program = debian::program("pdftotext", "poppler-utils");
    let output = Command::new(program).arg(mode).arg(pdf).arg("-").output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// A word on a sheet with its box [pt]: left, top, right, bottom.
struct Word {
    text: String,
    sheet: usize,
    edges: [f64; 4],
}

fn words(pdf: &Path) -> Vec<Word> {
    let mut sheet = 0;
    let mut words = Vec::new();
    for line in text(pdf, "-bbox").lines() {
        sheet += usize::from(line.trim_start().starts_with("<page "));
        let Some(word) = line.trim_start().strip_prefix("<word ") else { continue };
        let mut parts = word.split('"');
        let edges = [(); 4].map(|()| parts.nth(1).expect("an edge").parse().expect("a number"));
        let text = word.split_once('>').expect("a tag").1.trim_end_matches("</word>").to_owned();
        words.push(Word { text, sheet, edges });
    }
    words
}

/// Every word stands between the margins of A4, and none stands on another.
fn assert_readable(pdf: &Path) {
    let words = words(pdf);
    assert!(words.len() > 300, "{} words", words.len());
    for (index, word) in words.iter().enumerate() {
        let [left, top, right, bottom] = word.edges;
        let inside = left >= 40.0 && right <= 595.0 - 40.0 && top >= 20.0 && bottom <= 842.0 - 15.0;
        assert!(inside, "sheet {}: \"{}\" at {:?}", word.sheet, word.text, word.edges);
        let below = words[index + 1..].iter().take_while(|other| other.sheet == word.sheet);
        for other in below {
            let width = right.min(other.edges[2]) - left.max(other.edges[0]);
            let height = bottom.min(other.edges[3]) - top.max(other.edges[1]);
            // Boxes reach a little over their letters, and a subscript into the word it ends.
            let crossed = width > 2.0 && height > 0.45 * (bottom - top);
            assert!(
                !crossed,
                "sheet {}: \"{}\" on \"{}\", {width:.1} by {height:.1} pt",
                word.sheet, word.text, other.text
            );
        }
    }
}

/// The numbers of the table of all runs, and of their intervals below, are those of the JSON.
fn assert_runs_agree(pdf: &Path, document: &Value) {
    let layout = text(pdf, "-layout");
    let lines: Vec<&str> = layout.lines().collect();
    for run in document["runs"].as_array().expect("runs") {
        let (id, kind) =
            (run["id"].as_str().expect("an id"), run["kind"].as_str().expect("a kind"));
        let is_row = |line: &str| {
            let mut words = line.split_whitespace();
            words.next() == Some(id) && words.next() == Some(kind)
        };
        let at = lines.iter().position(|line| is_row(line));
        let at = at.unwrap_or_else(|| panic!("{id} is not in the table of runs"));
        let condition = run["condition"].as_str().expect("a condition");
        let means = lines[at].split_once(condition).expect("its condition").1.split_whitespace();
        let five = run["equivalent_damping_per_s"].as_array().expect("a list").iter();
        let five = &five.clone().find(|at| at["amplitude_deg"] == 5.0).expect("5 deg")["value"];
        let estimates = [&run["natural_frequency_rad_s"], &run["b1_per_s"], &run["b3_s"], five];
        let mut exact = vec![&run["froude"]];
        exact.extend(estimates.map(|estimate| &estimate["mean"]));
        exact.push(&run["resimulation_rmse_deg"]);
        assert_rounded(&means.collect::<Vec<_>>().join(" "), &exact);
        let ends: Vec<&Value> = estimates.iter().flat_map(|e| [&e["lo95"], &e["hi95"]]).collect();
        assert_rounded(lines[at + 1].trim(), &ends);
    }
}

#[test]
fn a_report_of_every_kind_of_run_is_readable_on_paper_with_the_numbers_of_the_contract() {
    let campaign = synthetic_results::campaign("A \"day\" in <the> basin");
    let whole = synthetic_results::results();
    let results = Results {
        runs: whole.runs.iter().step_by(9).cloned().collect(),
        froude_laws: whole.froude_laws.clone(),
        rejected: whole.rejected.clone(),
        overviews: whole.overviews.clone(),
    };
    let folder = tempfile::tempdir().unwrap();
    chromium::program();
    report::write_all(&campaign, &results, folder.path()).unwrap();
    report::write_diagnosis(&campaign, None, folder.path()).unwrap();
    let print = |extent| pipeline::print_report(&campaign.name, &results, folder.path(), extent);
    let pdf = print(Extent::EveryPage).unwrap();
    assert_readable(&pdf);
    let document = report::identification_json(&campaign, &results);
    assert_runs_agree(&pdf, &serde_json::from_str(&document).unwrap());
    let text = text(&pdf, "-layout");
    let n_sheets = text.matches('\u{c}').count();
    let n_heads = text.matches("A \"day\" in <the> basin\n").count();
    assert!(n_heads >= n_sheets, "{n_heads} heads on {n_sheets} sheets");
    assert!(text.contains(&format!("page {n_sheets} of {n_sheets}")), "sheets are numbered");
    // Paper cannot be unfolded, and says nothing twice.
    for stretch in &results.rejected {
        assert!(text.contains(&format!("{:.2}", stretch.start_s)));
    }
    assert_eq!(text.matches("Symbols and units.").count(), 1);
    assert!(!folder.path().join("printing").exists(), "the workshop is cleared away");
}

#[test]
fn a_summary_shows_two_runs_on_a_sheet_with_the_numbers_of_the_contract() {
    let campaign = synthetic_results::campaign("OE basin");
    let results = synthetic_results::results();
    let folder = tempfile::tempdir().unwrap();
    chromium::program();
    report::write_all(&campaign, &results, folder.path()).unwrap();
    report::write_diagnosis(&campaign, None, folder.path()).unwrap();
    let print = |extent| pipeline::print_report(&campaign.name, &results, folder.path(), extent);
    let pdf = print(Extent::Summary).unwrap();
    assert_readable(&pdf);
    let document = report::identification_json(&campaign, &results);
    assert_runs_agree(&pdf, &serde_json::from_str(&document).unwrap());
    let text = text(&pdf, "-layout");
    let sheets: Vec<&str> = text.split('\u{c}').collect();
    let n_runs_on = |sheet: &str| sheet.matches("Resimulated and measured roll.").count();
    let with_runs: Vec<usize> =
        sheets.iter().map(|sheet| n_runs_on(sheet)).filter(|n| *n > 0).collect();
    assert_eq!(with_runs.iter().sum::<usize>(), results.runs.len());
    assert_eq!(with_runs.len(), results.runs.len().div_ceil(2), "{with_runs:?}");
    for run in &results.runs {
        let title = format!("Run {}: ", run.id);
        let on = sheets.iter().find(|sheet| sheet.contains(&title)).expect("each has its title");
        assert!(n_runs_on(on) > 0, "{title} and its figure are together");
    }
}

#[test]
fn the_command_prints_a_campaign() {
    chromium::program();
    let folder = CampaignFolder::new();
    let report = ["report", ".", "-o", "results/paper", "--pdf", "--every-page"];
    let told = rolltank(folder.path(), &report);
    assert_eq!(told.exit, 0, "{}", told.err);
    assert!(told.out.contains("printed: results/paper/report.pdf"), "{}", told.out);
    let report = folder.path().join("results/paper");
    let document = fs::read_to_string(report.join("identification.json")).unwrap();
    assert_runs_agree(&report.join("report.pdf"), &serde_json::from_str(&document).unwrap());
    assert_readable(&report.join("report.pdf"));
}

#[test]
fn the_measured_decays_of_kvlcc2_are_readable_on_paper_with_the_numbers_of_the_contract() {
    let Some(measured) = kvlcc2_is_identified_as_published::folder() else { return };
    chromium::program();
    let report = tempfile::tempdir().unwrap();
    let (measured, dir) = (measured.display().to_string(), report.path().display().to_string());
    for more in [&[][..], &["--every-page"]] {
        let arguments = [&["report", &measured, "-o", &dir, "--pdf"], more].concat();
        let told = rolltank(report.path(), &arguments);
        assert_eq!(told.exit, 0, "{}", told.err);
        let document = fs::read_to_string(report.path().join("identification.json")).unwrap();
        let pdf = report.path().join("report.pdf");
        assert_runs_agree(&pdf, &serde_json::from_str(&document).unwrap());
        assert_readable(&pdf);
    }
}

#[test]
fn the_appendix_knows_each_recording_by_the_sum_that_sha256sum_prints() {
    let folder = CampaignFolder::new();
    assert_eq!(rolltank(folder.path(), &["replay", ".", "--seed", "7"]).exit, 0);
    let results = folder.path().join("results");
    let appendix = fs::read_to_string(results.join("appendix.json")).unwrap();
    let appendix: Value = serde_json::from_str(&appendix).unwrap();
    let recording = folder.path().join("pass_01.csv");
    let output = Command::new("sha256sum").arg(&recording).output().expect("coreutils are there");
    let sum = String::from_utf8(output.stdout).unwrap();
    let sum = sum.split_whitespace().next().unwrap();
    assert_eq!(appendix["files"][0]["sha256"], sum);
    assert_eq!(appendix["files"][0]["n_bytes"], fs::metadata(recording).unwrap().len());
    assert_eq!((&appendix["seed"], &appendix["version"]), (&7.into(), &"0.1.0".into()));
    let page = fs::read_to_string(results.join("appendix.html")).unwrap();
    assert!(page.contains(sum) && page.contains("0.1.0 with seed 7"));
    let campaign = fs::read_to_string(results.join("index.html")).unwrap();
    assert!(campaign.contains("href=\"appendix.html\""));
}

#[test]
fn without_a_browser_the_pages_are_there_and_the_error_says_what_to_do() {
    let folder = CampaignFolder::new();
    let report = ["report", ".", "-o", "results/paper", "--pdf"];
    let mut command = assert_cmd::Command::cargo_bin("rolltank").unwrap();
    let output = command
        .current_dir(folder.path())
        .args(report)
        .env("PATH", "/nowhere")
        .env_remove("ROLLTANK_CHROMIUM")
        .output()
        .unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(told.contains("error: no Chromium or Chrome is on PATH"), "{told}");
    assert!(told.contains("hint: install it (`apt-get install chromium`), or name it"), "{told}");
    assert!(folder.path().join("results/paper/index.html").is_file());
    // A program that is no browser prints nothing, and says so.
    let mut command = assert_cmd::Command::cargo_bin("rolltank").unwrap();
    let output = command
        .current_dir(folder.path())
        .args(report)
        .env("ROLLTANK_CHROMIUM", "/bin/true")
        .output()
        .unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("error: \"/bin/true\" printed nothing"), "{told}");
}
