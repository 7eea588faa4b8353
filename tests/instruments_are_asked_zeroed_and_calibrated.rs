//! `devices`, `check`, `zero` and `calibrate` at instruments on real ports.

use std::process::{Command, Stdio};

use super::campaign_folder::rolltank;
use super::live_tank::{CAMPAIGN, Daemon, LiveTank};

/// Runs a command to whom somebody enters lines: its exit code and what it said on either stream.
fn entered(tank: &LiveTank, arguments: &[&str], lines: &str) -> (Option<i32>, String, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_rolltank"))
        .args(arguments)
        .current_dir(tank.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program was built");
    // Who has given up does not read on.
    std::io::Write::write_all(&mut child.stdin.take().expect("it is piped"), lines.as_bytes()).ok();
    let ended = child.wait_with_output().expect("it is our child");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (ended.status.code(), text(&ended.stdout), text(&ended.stderr))
}

#[test]
fn devices_and_check_tell_who_answers_and_what_it_reads() {
    let tank = LiveTank::at_speed(1.0);
    let told = rolltank(tank.path(), &["devices", ".", "--seconds", "0.5"]);
    assert_eq!(told.exit, 0, "{}{}", told.out, told.err);
    for words in ["potentiometer on ", "rolltank emulated board", "roll: ", " rad, raw ", " Hz"] {
        assert!(told.out.contains(words), "{words} is not in:\n{}", told.out);
    }
    let told = rolltank(tank.path(), &["check", ".", "--seconds", "0.5"]);
    assert_eq!(told.exit, 0, "{}{}", told.out, told.err);
    assert!(
        told.out.contains("speed: ") && told.out.ends_with("no mistake found\n"),
        "{}",
        told.out
    );
    let list = rolltank(tank.path(), &["devices"]);
    assert!(list.out.contains("mantracourt-dsc"), "{}", list.out);
}

#[test]
fn a_port_that_is_missing_busy_or_another_instruments_is_told_with_its_line_and_a_remedy() {
    let tank = LiveTank::at_speed(1.0);
    tank.port(0).unplug();
    let told = rolltank(tank.path(), &["check", ".", "--seconds", "0.5"]);
    assert_eq!(told.exit, 1, "{}{}", told.out, told.err);
    // The first [[device]] begins on line 12 of the campaign file.
    assert!(told.err.contains("campaign.toml:12: device \"potentiometer\": port"), "{}", told.err);
    assert!(told.err.contains("does not exist\nhint: "), "{}", told.err);
    tank.port(0).replug();
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("linked", 2);
    let told = rolltank(tank.path(), &["check", ".", "--seconds", "0.5"]);
    assert!(told.err.contains("is in use by another program\nhint: close"), "{}", told.err);
    let zero = rolltank(tank.path(), &["zero", ".", "--by", "A. Nilsson", "--seconds", "0.3"]);
    assert!(zero.err.contains("hint: stop `rolltank run`, or let it"), "{}", zero.err);
    let address = daemon.address();
    let calibrate = ["calibrate", ".", "--channel", "speed", "--by", "B. Olsen"];
    let (code, out, err) = entered(&tank, &calibrate, "1.0\n");
    assert!(code == Some(1) && out.is_empty(), "{out}{err}");
    assert!(err.contains("calibrate with --page"), "{err}{}", daemon.said());
    let by_page = [&calibrate[..], &["--page", &address]].concat();
    let (code, out, err) = entered(&tank, &by_page, "1.0\n");
    // The daemon has read; one load makes no gain.
    assert!(out.contains("load 1 m/s: raw ") && out.contains(" readings"), "{out}{err}");
    assert!(code == Some(1) && err.contains("1 readings, at least 2"), "{err}");
    daemon.terminate();
    tank.edit("identify = true }", "identify = true }\nidentity = \"HBM\"");
    let told = rolltank(tank.path(), &["check", ".", "--seconds", "0.5"]);
    let wrong = "answers \"rolltank emulated board\", expected is \"HBM\"";
    assert!(told.err.contains(wrong), "{}", told.err);
}

#[test]
fn mistakes_between_devices_are_all_told_at_once_with_their_lines() {
    let twice = CAMPAIGN
        .replace("profile = \"arduino-text\"", "profile = \"arduino-txt\"")
        .replace("quantity = \"speed\"", "quantity = \"roll\"");
    let again = twice.split("[[device]]").nth(1).unwrap().replace("\"potentiometer\"", "\"copy\"");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("campaign.toml"), format!("{twice}\n[[device]]{again}"))
        .unwrap();
    let told = rolltank(folder.path(), &["check", "."]);
    assert_eq!(told.exit, 2, "{}", told.err);
    for words in [
        "campaign.toml:22: no profile is called \"arduino-txt\"",
        "roll is mapped twice: by device \"potentiometer\" and by device \"copy\"",
        "devices \"potentiometer\" and \"copy\" are both on port",
    ] {
        assert!(told.err.contains(words), "{words} is not in:\n{}", told.err);
    }
}

#[test]
fn a_zero_and_a_gain_are_taken_live_and_stand_in_the_next_recording() {
    // Loads are applied by hand, so that the model rests: its first six seconds.
    let tank = LiveTank::at_speed(0.25);
    let zero = ["zero", ".", "--by", "A. Nilsson", "--seconds", "0.5"];
    let told = rolltank(tank.path(), &zero);
    assert_eq!(told.exit, 0, "{}{}", told.out, told.err);
    assert!(told.out.contains("roll of potentiometer: zero "), "{}", told.out);
    let taken = tank.text("calibrations.toml");
    assert!(taken.contains("by = \"A. Nilsson\"") && taken.contains("UTC"), "{taken}");

    let calibrate =
        ["calibrate", ".", "--channel", "speed", "--by", "B. Olsen", "--seconds", "0.5"];
    // One load twice makes no gain, and is refused.
    let (code, _, said) = entered(&tank, &calibrate, "1.0\n1.0\n\n");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("all loads are 1, a gain needs two that differ"), "{said}");

    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("linked", 2);
    daemon.terminate();
    let files = tank.files("live", ".mcap");
    let mut recorded = replay::Recorded::open(&files[0]).unwrap();
    let mut by = Vec::new();
    while let Some(record) = recorded.next_record().unwrap() {
        if let replay::Record::Calibration(calibration) = record {
            by.push((calibration.channel, calibration.by, calibration.taken));
        }
    }
    assert_eq!(by[0].0, "roll");
    assert_eq!(by[0].1, "A. Nilsson");
    assert!(by[0].2.ends_with("UTC"), "{by:?}");
}
