//! Bad input is told with its place, its value, its limit and what to do, never with a panic.

use proptest::prelude::*;
use rolltank::campaign;

use super::campaign_folder::{CAMPAIGN, CampaignFolder, Told, decay, rolltank};

/// What `replay` says about a campaign that it cannot replay.
fn refused(campaign: &CampaignFolder, exit: i32) -> String {
    let Told { exit: ended, out, err } = rolltank(campaign.path(), &["replay", "."]);
    assert_eq!(ended, exit, "{out}\n{err}");
    assert!(err.starts_with("error: "), "{err}");
    assert!(!err.contains("panicked"), "{err}");
    err
}

#[track_caller]
fn tells(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in:\n{message}");
    }
}

#[test]
fn a_folder_without_campaign_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let told = rolltank(folder.path(), &["replay", "nowhere"]);
    assert_eq!(told.exit, 2);
    tells(&told.err, &["nowhere/campaign.toml", "hint: there is no folder \"nowhere\""]);
}

#[test]
fn a_missing_recording_is_told_with_its_line_and_the_file_that_was_meant() {
    let campaign = CampaignFolder::with("file = \"pass_01.csv\"", "file = \"pass_1.csv\"");
    let place = "campaign.toml:14: recording \"pass_1.csv\" is not there";
    tells(&refused(&campaign, 2), &[place, "hint: did you mean \"pass_01.csv\"?"]);
}

#[test]
fn a_recording_outside_the_folder_is_refused() {
    let campaign = CampaignFolder::with("file = \"pass_01.csv\"", "file = \"../pass_01.csv\"");
    tells(&refused(&campaign, 2), &["outside the campaign folder", "hint: copy it"]);
}

#[test]
fn a_recording_listed_twice_is_told_with_both_lines() {
    let campaign = CampaignFolder::with("gm_m", "gm_m");
    let twice = format!("{CAMPAIGN}[[recording]]\nfile = \"./pass_01.csv\"\n");
    campaign.write("campaign.toml", twice);
    tells(&refused(&campaign, 2), &["campaign.toml:18: ", "listed twice, first on line 13"]);
}

#[test]
fn a_missing_column_is_told_with_the_columns_that_are_there() {
    let campaign = CampaignFolder::with("column = \"roll\"", "column = \"rol\"");
    let message = refused(&campaign, 1);
    tells(
        &message,
        &["pass_01.csv", "no column \"rol\"", "\"t\", \"roll\"", "did you mean \"roll\"?"],
    );
}

#[test]
fn an_unknown_unit_is_told_with_the_known_ones() {
    let campaign = CampaignFolder::with("unit = \"deg\"", "unit = \"degrees\"");
    let message = refused(&campaign, 2);
    tells(&message, &["campaign.toml:12: ", "unknown unit \"degrees\" of roll", "rad, mrad, deg"]);
}

#[test]
fn a_misspelt_key_is_told_once_with_its_line_and_the_key_that_was_meant() {
    let campaign = CampaignFolder::with("displacement_m3", "displacment_m3");
    let message = refused(&campaign, 2);
    tells(&message, &["campaign.toml:6: unknown key `displacment_m3` in [hull]"]);
    tells(&message, &["hint: did you mean `displacement_m3`?"]);
    assert_eq!(message.matches("error: ").count(), 1, "{message}");
}

#[test]
fn a_missing_displacement_or_gm_is_told_with_its_table() {
    for key in ["displacement_m3 = 0.110\n", "gm_m = 0.074\n"] {
        let name = key.split(' ').next().unwrap();
        let message = refused(&CampaignFolder::with(key, ""), 2);
        tells(&message, &[&format!("campaign.toml:2: `{name}` in [hull] is missing"), "hint: add"]);
    }
}

#[test]
fn a_negative_or_endless_displacement_or_gm_is_told_with_its_value_and_limit() {
    for (key, written) in [
        ("displacement_m3 = 0.110", "displacement_m3 = -0.110"),
        ("gm_m = 0.074", "gm_m = -0.074"),
        ("gm_m = 0.074", "gm_m = nan"),
        ("gm_m = 0.074", "gm_m = inf"),
        ("gm_m = 0.074", "gm_m = 0"),
    ] {
        let message = refused(&CampaignFolder::with(key, written), 2);
        let (name, value) = written.split_once(" = ").unwrap();
        let value = value.trim_end_matches('0');
        tells(&message, &[&format!("`{name}` in [hull] is {value}"), "finite number above 0"]);
    }
}

#[test]
fn a_displacement_in_kilograms_is_seen_by_the_box_around_the_hull() {
    let message = refused(&CampaignFolder::with("= 0.110", "= 110.0"), 2);
    tells(&message, &["110 m3", "length x beam x draft", "hint: displacement_m3 is a volume"]);
}

#[test]
fn every_mistake_of_a_campaign_file_is_told_at_once() {
    let campaign = CampaignFolder::new();
    let broken = CAMPAIGN
        .replace("beam_m = 0.387", "beam_m = \"0,387\"")
        .replace("gm_m = 0.074", "gm = 0.074")
        .replace("\"deg\"", "\"grad\"")
        .replace("speed_m_s = 0.0", "speed_m_s = -1.0");
    campaign.write("campaign.toml", broken);
    let message = refused(&campaign, 2);
    assert_eq!(message.matches("error: ").count(), 4, "{message}");
    tells(&message, &["write beam_m = 0.387 without quotes", "`gm_m`", "\"grad\"", "is -1.0"]);
}

#[test]
fn a_froude_number_of_one_is_refused_with_the_arithmetic() {
    // sqrt(9.81 m/s2 x 2.5 m) = 4.95 m/s, and 2 m/s is Fr 0.404.
    let campaign = CampaignFolder::with("speed_m_s = 0.0", "speed_m_s = 4.95");
    let checked = rolltank(campaign.path(), &["check", "."]);
    assert_eq!(checked.exit, 2);
    let arithmetic = "Fr 1.00 needs 4.95 m/s, the carriage does 2.00 m/s (Fr 0.404)";
    tells(&checked.err, &["campaign.toml:13: ", arithmetic, "hint: "]);

    let replayed = rolltank(campaign.path(), &["replay", ".", "--json"]);
    assert_eq!(replayed.exit, 3, "the run was asked for and is refused: {}", replayed.err);
    tells(&replayed.out, &["\"runs\": []", "4.95 m/s", "2.00 m/s"]);
}

#[test]
fn text_and_nan_in_numbers_are_told_with_line_and_column() {
    for (cell, words) in [("n/a", "\"n/a\""), ("NaN", "\"NaN\""), ("1.2.3", "\"1.2.3\"")] {
        let campaign = CampaignFolder::new();
        campaign.replace_row(1200, &format!("11.980,{cell}"));
        let message = refused(&campaign, 1);
        tells(&message, &["pass_01.csv\" line 1200", "column \"roll\"", words, "hint: "]);
    }
}

#[test]
fn time_running_backwards_is_told_with_both_times() {
    let campaign = CampaignFolder::new();
    campaign.replace_row(1200, "3.5,0.1");
    let message = refused(&campaign, 1);
    tells(&message, &["pass_01.csv\" line 1200", "backwards", "3.5 s after 11.97", "hint: "]);
}

#[test]
fn an_empty_file_is_told_to_be_empty() {
    let campaign = CampaignFolder::new();
    campaign.write("pass_01.csv", "");
    tells(&refused(&campaign, 1), &["pass_01.csv\" is empty (0 bytes)", "hint: "]);
}

#[test]
fn two_recordings_of_the_same_minute_are_told_with_both_names_and_times() {
    let campaign = CampaignFolder::new();
    let noon_s = 1.7e9;
    campaign.write("pass_01.csv", decay(noon_s));
    campaign.write("pass_02.csv", decay(noon_s + 20.0));
    let listed = format!("{CAMPAIGN}[[recording]]\nfile = \"pass_02.csv\"\n");
    campaign.write("campaign.toml", listed);
    let message = refused(&campaign, 1);
    tells(&message, &["\"pass_01.csv\" (1700000000.000 s to 1700000029.990 s)"]);
    tells(&message, &["\"pass_02.csv\" (from 1700000020.000 s) overlap in time", "hint: "]);
}

#[test]
fn a_truncated_mcap_recording_is_read_as_far_as_it_goes_and_the_loss_is_told() {
    let campaign = CampaignFolder::new();
    assert_eq!(rolltank(campaign.path(), &["import", ".", "-o", "."]).exit, 0);
    let whole = std::fs::read(campaign.path().join("pass_01.mcap")).unwrap();
    campaign.write("pass_01.mcap", &whole[..whole.len() * 7 / 10]);
    let listed = CAMPAIGN.replace("pass_01.csv", "pass_01.mcap");
    campaign.write("campaign.toml", listed);
    let told = rolltank(campaign.path(), &["replay", "."]);
    assert!([1, 3].contains(&told.exit), "{}", told.err);
    tells(&told.err, &["pass_01.mcap", "ERROR"]);
}

#[test]
fn a_file_that_only_calls_itself_mcap_is_refused() {
    let campaign = CampaignFolder::with("pass_01.csv", "pass_01.mcap");
    campaign.write("pass_01.mcap", decay(0.0));
    tells(&refused(&campaign, 1), &["pass_01.mcap\" is not an MCAP file", "hint: "]);
}

#[test]
fn a_broken_toml_file_is_told_with_its_line() {
    let campaign = CampaignFolder::with("[hull]", "[hull");
    tells(&refused(&campaign, 2), &["campaign.toml:2: ", "hint: "]);
}

#[test]
fn check_ends_as_a_replay_of_a_bad_recording_would() {
    let campaign = CampaignFolder::new();
    campaign.replace_row(1200, "11.980,n/a");
    refused(&campaign, 1);
    let told = rolltank(campaign.path(), &["check", "."]);
    assert_eq!(told.exit, 1, "{}", told.err);
    tells(&told.err, &["campaign.toml:13: ", "line 1200", "hint: "]);
}

#[test]
fn a_clock_reading_for_a_time_is_told_with_the_way_around_it() {
    let campaign = CampaignFolder::new();
    campaign.replace_row(2, "10:15:00.000,0.1");
    tells(&refused(&campaign, 1), &["line 2", "\"10:15:00.000\"", "sample_rate_hz"]);
}

#[test]
fn a_recording_without_the_force_of_the_others_is_told_how_to_be_listed() {
    let campaign = CampaignFolder::new();
    let force = "force = { column = \"f\", unit = \"N\" }\n[exciter]\nmoment_arm_m = 0.43\n";
    let forced = CAMPAIGN.replace("[[recording]]", &format!("{force}[[recording]]"));
    campaign.write("campaign.toml", &forced);
    let listed = "files = { roll = \"pass_01.csv\" }";
    tells(&refused(&campaign, 1), &["no column \"f\" for force", listed]);
    campaign.write("campaign.toml", forced.replace("file = \"pass_01.csv\"", listed));
    assert_eq!(rolltank(campaign.path(), &["identify", "."]).exit, 0);
}

#[test]
fn a_force_without_the_arm_that_makes_a_moment_of_it_is_told_with_its_line() {
    let force = "unit = \"deg\" }\nforce = { column = \"f\", unit = \"N\" }";
    let campaign = CampaignFolder::with("unit = \"deg\" }", force);
    let message = refused(&campaign, 2);
    tells(&message, &["campaign.toml:13: a force is recorded", "hint: add [exciter]"]);
}

#[test]
fn an_umlaut_of_another_encoding_is_told_with_its_line() {
    let campaign = CampaignFolder::new();
    let latin1 = CAMPAIGN.replace("bare hull", "Sch\u{0}rze").into_bytes();
    let latin1: Vec<u8> = latin1.iter().map(|&b| if b == 0 { 0xfc } else { b }).collect();
    campaign.write("campaign.toml", latin1);
    tells(&refused(&campaign, 2), &["campaign.toml:15: ", "UTF-8", "hint: save the file"]);
}

#[test]
fn a_table_beside_its_own_import_is_not_counted_twice() {
    let campaign = CampaignFolder::new();
    let unlisted = CAMPAIGN.split("[[recording]]").next().unwrap();
    campaign.write("campaign.toml", unlisted);
    assert_eq!(rolltank(campaign.path(), &["import", ".", "-o", "."]).exit, 0);
    tells(&refused(&campaign, 2), &["pass_01.csv", "pass_01.mcap", "twice", "hint: "]);
}

proptest! {
    #[test]
    fn a_campaign_file_damaged_anywhere_is_read_or_told_with_lines_that_it_has(
        start in 0..CAMPAIGN.len(),
        length in 0..40_usize,
        patch in "[a-z0-9=.,\"\\[\\]{}\n -]{0,12}|nan|inf|1e400|-1|true|\u{fffd}",
    ) {
        let end = (start + length).min(CAMPAIGN.len());
        let damaged = format!("{}{patch}{}", &CAMPAIGN[..start], &CAMPAIGN[end..]);
        let campaign = CampaignFolder::new();
        campaign.write("campaign.toml", &damaged);
        if let Err(mistakes) = campaign::read(campaign.path()) {
            prop_assert!(!mistakes.is_empty());
            for mistake in mistakes {
                let n_lines = damaged.split('\n').count();
                prop_assert!(mistake.line.is_none_or(|line| (1..=n_lines).contains(&line)));
                prop_assert!(mistake.hint.is_some(), "{mistake}");
            }
        }
    }
}
