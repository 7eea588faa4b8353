//! Judgements beside a campaign are read by every identification, and told where they are wrong.

use serde_json::Value;

use super::campaign_folder::{CampaignFolder, rolltank};

fn reject(number: u32, end_s: f64) -> String {
    format!(
        "{{\"number\":{number},\"at\":\"2026-11-26 09:12:33 UTC\",\"by\":\"C. Costa\",\
         \"why\":\"a hand touched it\",\"what\":\"reject\",\"run\":{{\"recording\":\"pass_01.csv\",\
         \"start_s\":0.0,\"end_s\":{end_s}}}}}\n"
    )
}

const UNDO: &str = "{\"number\":2,\"at\":\"2026-11-26 09:13:00 UTC\",\"by\":\"C. Costa\",\
     \"why\":\"\",\"what\":\"undo\",\"of\":1}\n";

fn identified(campaign: &CampaignFolder) -> (i32, Value) {
    let told = rolltank(campaign.path(), &["identify", ".", "--json"]);
    (told.exit, serde_json::from_str(&told.out).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn a_rejected_run_is_no_run_until_that_is_undone_and_its_page_stays() {
    let campaign = CampaignFolder::new();
    let (exit, before) = identified(&campaign);
    assert_eq!(exit, 0);
    let run = &before["runs"][0];
    let end_s = run["end_s"].as_f64().expect("an end");

    campaign.write("judgements.jsonl", reject(1, end_s));
    let (exit, judged) = identified(&campaign);
    assert_eq!(exit, 3, "the listed recording gives no run");
    assert_eq!(judged["runs"], Value::Array(Vec::new()));
    assert_eq!(judged["froude_law"], Value::Array(Vec::new()));
    let rejected = judged["rejected"].as_array().expect("a list").last().expect("the run");
    let reason = "rejected by hand by C. Costa, 2026-11-26 09:12:33 UTC: a hand touched it";
    assert_eq!(rejected["reason"], reason);
    assert_eq!((&rejected["run"], &rejected["end_s"]), (&run["id"], &run["end_s"]));
    assert_eq!(rolltank(campaign.path(), &["replay", "."]).exit, 3);
    let page = format!("results/run-{}.html", run["id"].as_str().expect("an id"));
    let page =
        || std::fs::read_to_string(campaign.path().join(&page)).expect("it can be looked at");
    assert!(page().contains(&format!("This run is {reason}")), "its own page says so");
    let diagnosis = rolltank(campaign.path(), &["diagnose", ".", "--json"]);
    let diagnosis: Value = serde_json::from_str(&diagnosis.out).expect("JSON");
    assert!(diagnosis["verdict"].is_null(), "{diagnosis}");

    campaign.write("judgements.jsonl", reject(1, end_s) + UNDO);
    assert_eq!(identified(&campaign), (0, before.clone()));
    assert_eq!(rolltank(campaign.path(), &["replay", "."]).exit, 0);
    assert!(!page().contains("rejected by hand"), "it was taken again");

    let again = UNDO.replace("\"number\":2", "\"number\":3").replace("\"of\":1", "\"of\":2");
    campaign.write("judgements.jsonl", reject(1, end_s) + UNDO + &again);
    assert_eq!(identified(&campaign), (3, judged), "an undo that is undone is none");

    let note = reject(1, end_s).replace("\"reject\"", "\"annotate\"");
    campaign.write("judgements.jsonl", note);
    assert_eq!(rolltank(campaign.path(), &["replay", "."]).exit, 0);
    assert!(page().contains("C. Costa noted: a hand touched it"), "notes stand beside the run");
}

#[test]
fn a_line_that_is_no_judgement_is_told_with_its_place_and_a_torn_one_is_none() {
    let campaign = CampaignFolder::new();
    campaign.write("judgements.jsonl", reject(1, 9.0) + "{\"number\": 2}\n" + UNDO);
    let told = rolltank(campaign.path(), &["check", "."]);
    assert_eq!(told.exit, 2, "{}", told.err);
    assert!(
        told.err.contains("judgements.jsonl:2: is no judgement: missing field"),
        "{}",
        told.err
    );
    campaign.write("judgements.jsonl", "{\"number\": 1, \"at\"");
    assert_eq!(identified(&campaign).0, 0);
}
