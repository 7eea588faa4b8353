//! The commands as a shell sees them: exit codes, output, and files only where they belong.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::campaign_folder::{CAMPAIGN, CampaignFolder, rolltank};

/// The files of a campaign that lie outside its results folder.
fn outside_results(campaign: &CampaignFolder) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = campaign.snapshot();
    files.retain(|path, _| !path.starts_with("results"));
    files
}

#[test]
fn replay_leaves_its_report_in_results_and_touches_nothing_else() {
    let campaign = CampaignFolder::new();
    let before = outside_results(&campaign);
    let told = rolltank(campaign.path(), &["replay", "."]);
    assert_eq!(told.exit, 0, "{}", told.err);
    assert!(told.out.contains("bare hull") && told.out.contains("report: "), "{}", told.out);
    assert_eq!(outside_results(&campaign), before);
    let written = campaign.snapshot();
    for name in ["index.html", "run-pass_01-1.html", "identification.json", "catalogue.sqlite"] {
        let path = Path::new("results").join(name);
        assert!(written.get(&path).is_some_and(|bytes| !bytes.is_empty()), "{name} is not there");
    }
}

#[test]
fn identify_and_check_write_nothing_at_all() {
    let campaign = CampaignFolder::new();
    let before = campaign.snapshot();
    for command in ["identify", "check"] {
        let told = rolltank(campaign.path(), &[command, "."]);
        assert_eq!(told.exit, 0, "{}", told.err);
        assert_eq!(campaign.snapshot(), before);
    }
}

#[test]
fn a_campaign_that_may_only_be_read_is_identified_and_reported_elsewhere() {
    let campaign = CampaignFolder::new();
    let elsewhere = tempfile::tempdir().unwrap();
    for file in ["campaign.toml", "pass_01.csv"] {
        let path = campaign.path().join(file);
        let mut permissions = path.metadata().unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions).unwrap();
    }
    let before = campaign.snapshot();
    let dir = elsewhere.path().join("report");
    let told = rolltank(campaign.path(), &["report", ".", "-o", dir.to_str().unwrap()]);
    assert_eq!(told.exit, 0, "{}", told.err);
    assert!(dir.join("index.html").is_file());
    assert_eq!(campaign.snapshot(), before);
}

#[test]
fn the_same_campaign_replayed_twice_gives_the_same_bytes() {
    let campaign = CampaignFolder::new();
    let first = rolltank(campaign.path(), &["replay", ".", "--json"]);
    let json = campaign.path().join("results/identification.json");
    let written = std::fs::read(&json).unwrap();
    let second = rolltank(campaign.path(), &["replay", ".", "--json"]);
    assert_eq!(first.exit, 0, "{}", first.err);
    assert!(first.out.contains("\"schema\": \"rolltank.identification/1\""), "{}", first.out);
    assert!(first.out.contains("\"id\": \"pass_01-1\""), "{}", first.out);
    assert_eq!(first.out, second.out);
    assert_eq!(std::fs::read(&json).unwrap(), written);
    assert_eq!(written, first.out.into_bytes());
}

#[test]
fn a_paced_replay_gives_the_bytes_of_a_flat_out_one() {
    let campaign = CampaignFolder::new();
    let flat_out = rolltank(campaign.path(), &["replay", ".", "--json"]);
    let paced = rolltank(campaign.path(), &["replay", ".", "--json", "--speed", "100"]);
    assert_eq!(flat_out.out, paced.out);
}

#[test]
fn pages_of_runs_that_are_no_more_do_not_stay() {
    let campaign = CampaignFolder::new();
    campaign.write("results/run-pass_09-1.html", "a run of an earlier replay");
    campaign.write("results/notes.txt", "the test leader's own");
    assert_eq!(rolltank(campaign.path(), &["replay", "."]).exit, 0);
    assert!(!campaign.path().join("results/run-pass_09-1.html").exists());
    assert!(campaign.path().join("results/notes.txt").exists());
}

#[test]
fn pages_of_an_earlier_report_do_not_stay_in_its_folder_and_pages_of_others_do() {
    let campaign = CampaignFolder::new();
    campaign.write("pass_02.csv", super::campaign_folder::decay(0.0));
    let second = "[[recording]]\nfile = \"pass_02.csv\"\n";
    campaign.write("campaign.toml", format!("{CAMPAIGN}{second}"));
    let elsewhere = tempfile::tempdir().unwrap();
    let dir = elsewhere.path();
    std::fs::write(dir.join("run-mine.html"), "the test leader's own").unwrap();
    let report = ["report", ".", "-o", dir.to_str().unwrap()];
    assert_eq!(rolltank(campaign.path(), &report).exit, 0);
    assert!(dir.join("run-pass_02-1.html").exists());
    campaign.write("campaign.toml", CAMPAIGN);
    assert_eq!(rolltank(campaign.path(), &report).exit, 0);
    assert!(!dir.join("run-pass_02-1.html").exists());
    assert!(dir.join("run-pass_01-1.html").exists() && dir.join("run-mine.html").exists());
}

#[test]
fn a_report_among_the_recordings_is_refused_because_its_tables_would_be_read_as_some() {
    let campaign = CampaignFolder::new();
    for dir in [".", "report", "a/b"] {
        let told = rolltank(campaign.path(), &["report", ".", "-o", dir]);
        assert_eq!(told.exit, 2, "{}", told.err);
        assert!(told.err.contains("inside the campaign folder"), "{}", told.err);
        assert!(told.err.contains("hint: name a folder outside"), "{}", told.err);
    }
    assert_eq!(rolltank(campaign.path(), &["report", ".", "-o", "results/appendix"]).exit, 0);
    assert!(campaign.path().join("results/appendix/index.html").is_file());
}

#[cfg(unix)]
#[test]
fn a_link_to_a_recording_does_not_count_its_runs_twice() {
    let campaign = CampaignFolder::new();
    let unlisted = CAMPAIGN.split("[[recording]]").next().unwrap();
    campaign.write("campaign.toml", unlisted);
    std::os::unix::fs::symlink("pass_01.csv", campaign.path().join("yesterday.csv")).unwrap();
    let told = rolltank(campaign.path(), &["identify", ".", "--json"]);
    assert_eq!(told.exit, 0, "{}", told.err);
    let told: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    assert_eq!(told["runs"].as_array().map(Vec::len), Some(1), "{told}");
}

#[test]
fn imported_recordings_give_the_runs_of_their_tables() {
    let campaign = CampaignFolder::new();
    let table = rolltank(campaign.path(), &["identify", ".", "--json"]);
    assert_eq!(rolltank(campaign.path(), &["import", ".", "-o", "."]).exit, 0);
    campaign.write("campaign.toml", CAMPAIGN.replace("pass_01.csv", "pass_01.mcap"));
    let imported = rolltank(campaign.path(), &["identify", ".", "--json"]);
    assert_eq!(imported.exit, 0, "{}", imported.err);
    assert_eq!(table.out.replace("pass_01.csv", "pass_01.mcap"), imported.out);
}

#[test]
fn a_recording_that_was_asked_for_and_gives_no_run_ends_with_three() {
    let campaign = CampaignFolder::new();
    let still: Vec<String> = (0..1000).map(|k| format!("{k},0.00")).collect();
    campaign.write("pass_01.csv", format!("t,roll\n{}", still.join("\n")));
    let told = rolltank(campaign.path(), &["replay", "."]);
    assert_eq!(told.exit, 3, "{}", told.err);
    assert!(told.err.contains("recording \"pass_01.csv\" gave no run"), "{}", told.err);
}

#[test]
fn check_tells_what_each_recording_holds() {
    let campaign = CampaignFolder::new();
    let told = rolltank(campaign.path(), &["check", "."]);
    assert!(told.out.contains("pass_01.csv: 30.0 s, roll 3000 samples"), "{}", told.out);
    assert!(told.out.ends_with("no mistake found\n"), "{}", told.out);
    let json = rolltank(campaign.path(), &["check", ".", "--json"]).out;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["schema"], "rolltank.check/1");
    assert_eq!(json["ok"], true);
    assert_eq!(json["recordings"][0]["channels"][0]["n_samples"], 3000);
}

#[test]
fn wrong_usage_ends_with_two_and_help_with_zero() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [&["replay"][..], &["replay", ".", "--speed", "0"], &["indentify", "."]] {
        let told = rolltank(folder.path(), arguments);
        assert_eq!(told.exit, 2, "{arguments:?}: {}", told.err);
    }
    let help = rolltank(folder.path(), &["--help"]);
    assert_eq!(help.exit, 0);
    for command in ["demo", "check", "replay", "identify", "report", "simulate", "import"] {
        assert!(help.out.contains(command), "{command} is not in:\n{}", help.out);
    }
}

#[test]
fn the_errata_of_the_paper_are_told_for_people_and_programs() {
    let folder = tempfile::tempdir().unwrap();
    let text = rolltank(folder.path(), &["reference"]);
    assert_eq!(text.exit, 0, "{}", text.err);
    assert!(text.out.contains("Fr 1.0 needs 4.95 m/s"), "{}", text.out);
    let json = rolltank(folder.path(), &["reference", "--json"]).out;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["schema"], "rolltank.reference/1");
    for erratum in json["errata"].as_array().unwrap() {
        let title = erratum["title"].as_str().unwrap();
        assert!(text.out.contains(title), "{title}");
    }
}

#[test]
fn a_simulated_campaign_is_never_written_over_another() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(rolltank(folder.path(), &["simulate", "paper", "-o", "day"]).exit, 0);
    let again = rolltank(folder.path(), &["simulate", "paper", "-o", "day"]);
    assert_eq!(again.exit, 2);
    assert!(again.err.contains("\"day\" exists already"), "{}", again.err);
    assert!(again.err.contains("hint: "), "{}", again.err);
}

#[test]
fn a_scenario_that_is_not_there_is_told_with_those_that_are() {
    let folder = tempfile::tempdir().unwrap();
    let told = rolltank(folder.path(), &["simulate", "papr", "-o", "day"]);
    assert_eq!(told.exit, 2, "{}", told.err);
    assert!(told.err.contains("scenario \"papr\" cannot be read"), "{}", told.err);
    assert!(told.err.contains("built-in scenario paper"), "{}", told.err);
    assert!(!folder.path().join("day").exists());
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let campaign = CampaignFolder::new();
    // More output than a pipe holds, so that the writer meets the closed end.
    let many: Vec<String> =
        (0..3000).map(|k| format!("[[recording]]\nfile = \"p{k}.csv\"\n")).collect();
    campaign.write("campaign.toml", CAMPAIGN.to_owned() + &many.concat());
    let mut child = Command::new(env!("CARGO_BIN_EXE_rolltank"))
        .current_dir(campaign.path())
        .args(["check", ".", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(0));
    assert!(ended.stderr.is_empty(), "{}", String::from_utf8_lossy(&ended.stderr));
}
