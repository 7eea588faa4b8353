//! A wrong unit or sign is told with its reason; it never becomes a damping.

use serde_json::Value;

use super::campaign_folder::{CAMPAIGN, CampaignFolder, rolltank};

/// Forced rolling below resonance, near it and above, where a wrong force shows differently.
const FORCED: &str = r#"name = "forced"
[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[tank]
length_m = 50.0
width_m = 10.0
depth_m = 5.0
carriage_max_speed_m_s = 2.0
[exciter]
moment_arm_m = 0.43
[instruments.roll]
sample_rate_hz = 100.0
noise_deg = 0.05
quantum_deg = 0.02
[instruments.force]
sample_rate_hz = 100.0
noise_n = 0.12
quantum_n = 0.05
[[condition]]
name = "bare hull"
natural_frequency_rad_s = 6.905
damping.law = { b0_per_s = 0.38, kappa = 5.0, b3_s = 0.14 }
[[pass]]
condition = "bare hull"
froude = 0.0
action = [
  { rest = { duration_s = 10.0 } },
  { forced = { amplitude_deg = 10.0, frequency_rad_s = 5.5, duration_s = 15.0, ramp_s = 2.0 } },
  { forced = { amplitude_deg = 10.0, frequency_rad_s = 6.9, duration_s = 15.0 } },
  { forced = { amplitude_deg = 10.0, frequency_rad_s = 8.5, duration_s = 15.0 } },
]
"#;

/// The identification of forced rolling with one passage of the campaign file replaced, its exit
/// code and what was said beside it.
fn forced_with(from: &str, to: &str) -> (Value, i32, String) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    std::fs::write(folder.path().join("forced.toml"), FORCED).expect("the disk has room");
    assert_eq!(rolltank(folder.path(), &["simulate", "forced.toml", "-o", "day"]).exit, 0);
    let path = folder.path().join("day/campaign.toml");
    let text = std::fs::read_to_string(&path).expect("it was written");
    assert!(text.contains(from), "`{from}` is not in:\n{text}");
    std::fs::write(&path, text.replace(from, to)).expect("the disk has room");
    let told = rolltank(folder.path(), &["identify", "day", "--json"]);
    let json = serde_json::from_str(&told.out).expect("nothing but JSON is on standard output");
    (json, told.exit, told.err)
}

/// How many stretches were rejected for a reason with these words.
fn rejected_with(identification: &Value, words: &str) -> usize {
    let rejected = identification["rejected"].as_array().expect("a list").iter();
    let reasons = rejected.map(|stretch| stretch["reason"].as_str().expect("a sentence"));
    reasons.filter(|reason| reason.contains(words)).count()
}

#[test]
fn a_force_a_thousand_times_too_small_or_too_large_gives_no_damping() {
    let (right, exit, _) = forced_with("unit = \"N\"", "unit = \"N\"");
    assert_eq!((right["runs"].as_array().unwrap().len(), exit), (3, 0), "{right:#}");
    for unit in ["unit = \"mN\"", "unit = \"kN\""] {
        let (identification, exit, err) = forced_with("unit = \"N\"", unit);
        assert_eq!(identification["runs"], Value::Array(Vec::new()), "{unit}");
        assert_eq!(exit, 3, "the runs were asked for: {err}");
        assert!(err.contains("runs/pass_01.csv\" gave no run"), "{err}");
        assert_eq!(rejected_with(&identification, "hint: "), 3, "{identification:#}");
    }
}

#[test]
fn a_reversed_load_cell_is_refused_with_the_key_that_mends_it() {
    let (identification, exit, _) = forced_with("force_sign = 1.0", "force_sign = -1.0");
    assert_eq!(identification["runs"], Value::Array(Vec::new()));
    assert_eq!(rejected_with(&identification, "force_sign = -1"), 3, "{identification:#}");
    assert_eq!(exit, 3);
}

#[test]
fn degrees_declared_as_radians_turn_the_model_over_and_are_refused() {
    let campaign = CampaignFolder::with("unit = \"deg\"", "unit = \"rad\"");
    let told = rolltank(campaign.path(), &["identify", ".", "--json"]);
    assert_eq!(told.exit, 3, "{}", told.err);
    let identification: Value = serde_json::from_str(&told.out).unwrap();
    assert_eq!(identification["runs"], Value::Array(Vec::new()));
    assert!(rejected_with(&identification, "check the unit") > 0, "{identification:#}");
}

#[test]
fn radians_declared_as_degrees_are_told_with_the_roll_that_they_make() {
    // 15 deg are 0.26 rad, read as 0.26 deg: too little above the last digit to be a roll.
    let campaign = CampaignFolder::new();
    let listed = CAMPAIGN.split("[[recording]]").next().unwrap();
    campaign.write("campaign.toml", listed);
    let table = std::fs::read_to_string(campaign.path().join("pass_01.csv")).unwrap();
    let in_radians = table.lines().map(|line| match line.split_once(',') {
        Some((time, roll)) if roll != "roll" => {
            format!("{time},{:.4}\n", roll.parse::<f64>().unwrap().to_radians())
        }
        _ => format!("{line}\n"),
    });
    campaign.write("pass_01.csv", in_radians.collect::<String>());
    let told = rolltank(campaign.path(), &["identify", "."]);
    assert_eq!(told.exit, 3, "a campaign without a run is not done: {}", told.err);
    assert!(told.err.contains("0.26"), "{}", told.err);
    assert!(told.err.contains("hint: check the units of roll and time"), "{}", told.err);
}

#[test]
fn an_arm_in_millimetres_is_longer_than_the_model_and_refused() {
    let campaign = CampaignFolder::new();
    campaign.write("campaign.toml", format!("{CAMPAIGN}[exciter]\nmoment_arm_m = 430.0\n"));
    let told = rolltank(campaign.path(), &["check", "."]);
    assert_eq!(told.exit, 2, "{}", told.err);
    assert!(told.err.contains("campaign.toml:18: moment_arm_m = 430 m"), "{}", told.err);
    assert!(told.err.contains("hint: moment_arm_m is in metres"), "{}", told.err);
}
