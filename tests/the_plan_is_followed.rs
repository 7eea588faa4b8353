//! The test plan: read from tables or from a CSV file, its mistakes told, its progress counted.

use std::f64::consts::TAU;

use rolltank::campaign::{self, Plan, PlannedRuns};
use rolltank::progress::progress;
use rolltank::run::RunKind;
use serde_json::Value;

use crate::campaign_folder::{CampaignFolder, rolltank};
use crate::synthetic_results;

const TABLES: &str = r#"[[plan]]
condition = "bare hull"
kind = "decay"
froude = 0.2
amplitude_deg = 15
repeats = 4
[[plan]]
condition = "bare hull"
kind = "forced"
speed_m_s = 0.99
period_s = 0.91
[[recording]]
"#;

const CSV: &str = "condition,kind,froude,speed_m_s,amplitude_deg,period_s,repeats
bare hull,decay,0.2,,15,,4
bare hull,forced,,0.99,,0.91,
";

fn with_csv(table: &str) -> CampaignFolder {
    let campaign = CampaignFolder::with("[hull]", "plan = \"plan.csv\"\n[hull]");
    campaign.write("plan.csv", table);
    campaign
}

#[test]
fn tables_and_a_csv_file_say_the_same() {
    let tables = campaign::read(CampaignFolder::with("[[recording]]\n", TABLES).path()).unwrap();
    let listed = campaign::read(with_csv(CSV).path()).unwrap();
    let without_lines = |plan: &Plan| -> Vec<PlannedRuns> {
        plan.rows.iter().map(|row| PlannedRuns { line: None, ..row.clone() }).collect()
    };
    let rows = without_lines(&tables.plan);
    assert_eq!(rows, without_lines(&listed.plan));
    assert_eq!((rows[0].kind, rows[0].repeats, rows[0].froude), (RunKind::Decay, 4, 0.2));
    assert!((rows[1].froude - 0.99 / (9.81_f64 * 2.5).sqrt()).abs() < 1e-12);
    assert_eq!(rows[1].frequency_rad_s, Some(TAU / 0.91));
    assert_eq!((rows[1].amplitude_rad, rows[1].repeats), (None, 1));
}

#[test]
fn the_file_of_the_plan_is_no_recording() {
    let folder = with_csv(CSV);
    let written = std::fs::read_to_string(folder.path().join("campaign.toml")).unwrap();
    let head = written.split("[[recording]]").next().unwrap();
    folder.write("campaign.toml", head);
    let names: Vec<String> = campaign::read(folder.path())
        .unwrap()
        .recordings
        .into_iter()
        .map(|recording| recording.name)
        .collect();
    assert_eq!(names, ["pass_01.csv"]);
}

#[test]
fn every_mistake_of_a_table_is_told_with_its_line() {
    let wrong = "condition;kind;froude;speed_m_s;frequency_rad_s;repeats;colour
bare hull;decay;0,2;;;4;
bare hull;dance;0,2;;;4;
bare hull;decay;;;;4;
bare hull;decay;0,2;;5,1;;
bare hull;forced;0,2;;;;red

bare hull;decay;fast;;;1,5;
bare hull;decay;0,8;;;;
";
    let folder = with_csv(wrong);
    let told = rolltank(folder.path(), &["check", "."]);
    assert_eq!(told.exit, 2, "{}", told.err);
    for (line, words) in [
        (3, "`kind` is \"dance\""),
        (4, "neither `froude` nor `speed_m_s` is given"),
        (5, "`frequency_rad_s` is given, but a decay has no excitation"),
        (6, "neither `frequency_rad_s` nor `period_s` is given"),
        (6, "unknown key `colour` in `[[plan]]`"),
        (8, "`froude` in `[[plan]]` is a string, expected a number"),
        (8, "`repeats` in `[[plan]]` is 1.5, but must be a whole number, 1 to 1000"),
    ] {
        let place = format!("plan.csv:{line}: ");
        let found =
            told.err.lines().any(|l| l.contains(&place) && plain(l).contains(&plain(words)));
        assert!(found, "{place}{words} is not in\n{}", told.err);
    }
    // What the carriage can't do is told once the rest is right.
    let folder = with_csv("condition,kind,froude\nbare hull,decay,0.8\n");
    let told = rolltank(folder.path(), &["check", "."]);
    let place = "plan.csv:2: plan for \"bare hull\": Fr 0.80 needs 3.96 m/s";
    assert!(told.exit == 2 && told.err.contains(place), "{}", told.err);
}

/// Without the marks about names, which are not the matter here.
fn plain(text: &str) -> String {
    text.replace('`', "")
}

#[test]
fn a_plan_that_is_not_there_is_told_at_its_key() {
    let campaign = CampaignFolder::with("[hull]", "plan = \"plan.csv\"\n[hull]");
    let told = rolltank(campaign.path(), &["check", "."]);
    assert_eq!(told.exit, 2);
    assert!(told.err.contains("campaign.toml:2: plan \"plan.csv\" cannot be read"), "{}", told.err);
}

fn planned(froude: f64, kind: RunKind, repeats: usize) -> PlannedRuns {
    PlannedRuns {
        condition: "bare hull".to_owned(),
        froude,
        kind,
        amplitude_rad: None,
        frequency_rad_s: None,
        repeats,
        line: None,
    }
}

#[test]
fn runs_count_for_the_row_that_they_fit_and_the_first_that_lacks_one_is_next() {
    let mut campaign = synthetic_results::campaign("OE basin");
    let results = synthetic_results::results();
    let natural_rad_s = 6.905;
    let at = |ratio: f64| PlannedRuns {
        frequency_rad_s: Some(1.01 * ratio * natural_rad_s),
        ..planned(0.203, RunKind::Forced, 1)
    };
    campaign.plan.rows = vec![
        planned(0.0, RunKind::Decay, 1),
        planned(0.203, RunKind::Decay, 2),
        at(0.74),
        at(0.8),
        // The same as the second row: whichever lacks a run takes it.
        planned(0.2, RunKind::Decay, 1),
    ];
    let found = progress(&campaign, &results.runs);
    let done: Vec<usize> = found.rows.iter().map(|row| row.done.len()).collect();
    assert_eq!(done, [1, 0, 1, 0, 1]);
    assert_eq!((found.next, found.n_done, found.n_asked), (Some(1), 3, 6));
    assert_eq!(found.unplanned.len(), results.runs.len() - 3);
    assert_eq!(found.rows[1].words(), "decay at Fr 0.203 (1.01 m/s), bare hull");
    // Three decays at one speed: one each until both rows are full.
    let decay = results.runs.iter().find(|run| run.froude > 0.19 && run.run.kind == RunKind::Decay);
    let three = [decay.unwrap(); 3];
    let found = progress(&campaign, three);
    assert_eq!((found.rows[1].done.len(), found.rows[4].done.len()), (2, 1));
}

#[test]
fn amplitudes_part_rows_that_are_otherwise_alike() {
    let mut campaign = synthetic_results::campaign("OE basin");
    let results = synthetic_results::results();
    let from = |amplitude_deg: f64| PlannedRuns {
        amplitude_rad: Some(amplitude_deg.to_radians()),
        ..planned(0.0, RunKind::Decay, 1)
    };
    let heel_deg = results.runs[0].identification.initial_roll_rad.mean.abs().to_degrees();
    campaign.plan.rows = vec![from(0.6 * heel_deg), from(1.1 * heel_deg), from(1.3 * heel_deg)];
    let found = progress(&campaign, &results.runs[..1]);
    assert_eq!(found.rows.iter().map(|row| row.done.len()).collect::<Vec<_>>(), [0, 1, 0]);
}

#[test]
fn page_and_contract_tell_the_progress() {
    let folder = CampaignFolder::with("[[recording]]\n", TABLES);
    let plan = TABLES.replace("froude = 0.2\n", "froude = 0.0\n");
    let written = std::fs::read_to_string(folder.path().join("campaign.toml")).unwrap();
    folder.write("campaign.toml", written.replace(TABLES, &plan));
    assert_eq!(rolltank(folder.path(), &["replay", "."]).exit, 0);
    let results = folder.path().join("results");
    let document = std::fs::read_to_string(results.join("identification.json")).unwrap();
    let document: Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["plan"]["rows"][0]["done"][0], document["runs"][0]["id"]);
    assert_eq!(document["plan"]["next"], 0);
    let page = std::fs::read_to_string(results.join("index.html")).unwrap();
    assert!(page.contains("1 of 5 runs asked for are done; next: decay from 15.0 deg at Fr 0.000"));
}
