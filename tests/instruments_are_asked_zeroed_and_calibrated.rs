//! `devices`, `check`, `zero` and `calibrate` at instruments on real ports.

use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering;

use devices::Quantity;
use devices::channel::{Calibration, Curve};

use super::campaign_folder::rolltank;
use super::http::get;
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
    Write::write_all(&mut child.stdin.take().expect("it is piped"), lines.as_bytes()).ok();
    let ended = child.wait_with_output().expect("it is our child");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (ended.status.code(), text(&ended.stdout), text(&ended.stderr))
}

/// Calibrates the force cell with loads [N] and the counts that each adds to its reading, each on
/// the cell before it is entered; the line for each load, and what is said at the end.
fn loaded(tank: &LiveTank, more: &[&str], loads: &[(i64, i64)]) -> (Vec<String>, Vec<String>) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_rolltank"))
        .args(["calibrate", ".", "--channel", "force", "--by", "B. Olsen"])
        .args(more)
        .current_dir(tank.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program was built");
    let (enter, told) = (child.stdin.take(), child.stdout.take());
    let (mut enter, told) = (enter.expect("it is piped"), told.expect("it is piped"));
    let mut told = BufReader::new(told).lines().map(|line| line.expect("text"));
    let mut each = |(load_n, counts): &(i64, i64)| {
        tank.load_counts.store(*counts, Ordering::Relaxed);
        writeln!(enter, "{load_n}").expect("it listens");
        told.next().expect("a line for each load")
    };
    let lines = loads.iter().map(&mut each).collect();
    writeln!(enter).expect("it listens");
    let last = told.collect();
    assert!(child.wait().expect("it is our child").success(), "{last:?}");
    (lines, last)
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
    // Its lines carry readings alone.
    assert!(told.out.contains("carriage (115200 8N1): cannot say who it is\n"), "{}", told.out);
    assert!(!told.out.contains("note: "), "{}", told.out);
    let list = rolltank(tank.path(), &["devices"]);
    assert!(list.out.contains("mantracourt-dsc"), "{}", list.out);
}

#[test]
fn one_instrument_alone_is_asked_without_a_campaign() {
    let tank = LiveTank::at_speed(1.0);
    let port = tank.port(0).path().display().to_string();
    let ask = |more: &[&str]| {
        let one = ["devices", "--port", &port, "--profile", "cobs-board", "--seconds", "1.5"];
        rolltank(tank.path(), &[&one[..], more].concat())
    };
    let told = ask(&["--settings", "fields = 1"]);
    assert_eq!(told.exit, 0, "{}{}", told.out, told.err);
    let head = format!("{port} (921600 8N1): rolltank emulated board\n  field 0 (value 0): ");
    assert!(told.out.starts_with(&head) && told.out.ends_with(" Hz\n"), "{}", told.out);
    let told = ask(&["--settings", "fields = 1", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    let field = &told["devices"][0]["fields"][0];
    assert!(field["raw"].is_f64() && field["rate_hz"].as_f64() > Some(50.0), "{told}");
    // Frames of another length are no frames of this profile.
    let told = ask(&[]);
    assert!(told.exit == 1 && told.out.contains("field 1 (value 1): no value"), "{}", told.out);
    assert!(told.out.contains("hint: "), "{}", told.out);
    let told = ask(&["--settings", "fields: 1"]);
    let words = "expected NAME = VALUE, NAME = VALUE, as in a campaign file";
    assert!(told.exit == 1 && told.err.contains(words), "{}{}", told.out, told.err);
}

#[test]
fn a_port_by_the_kernels_name_is_told_with_its_stable_one() {
    let tank = LiveTank::at_speed(1.0);
    let stable = tank.port(1).path().to_owned();
    let device = stable.canonicalize().expect("it is plugged in").display().to_string();
    let by_id = stable.parent().expect("a folder").display().to_string();
    tank.edit(&stable.display().to_string(), &device);
    let check = ["check", ".", "--seconds", "0.5", "--by-id", &by_id];
    let told = rolltank(tank.path(), &check);
    let note = format!(
        "  note: {device} may be another instrument's after replugging; write port = \"{}\"\n",
        stable.display()
    );
    assert!(told.exit == 0 && told.out.contains(&note), "{}{}", told.out, told.err);
    assert_eq!(told.out.matches("note: ").count(), 1, "{}", told.out);
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
    // On a busy machine the daemon may hardly have read yet, and says so.
    let (code, out, err) = (0..40)
        .map(|_| entered(&tank, &by_page, "1.0\n"))
        .find(|(_, _, err)| !err.contains("too few readings"))
        .expect("the daemon reads");
    // The daemon has read; one load makes no gain.
    assert!(out.contains("load 1 m/s: raw ") && out.contains(" readings"), "{out}{err}");
    assert!(code == Some(1) && err.contains("different loads: 1, this curve needs 2"), "{err}");
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
    let named = CAMPAIGN.replace("PORTS/carriage\"", "/dev/x\"\nidentity = \"VBW\"");
    std::fs::write(folder.path().join("campaign.toml"), named).unwrap();
    let unasked = rolltank(folder.path(), &["check", "."]);
    let words =
        "campaign.toml:22: device \"carriage\": identity is \"VBW\", but driver \"text-line\"";
    assert!(unasked.exit == 2 && unasked.err.contains(words), "{}", unasked.err);
    assert!(unasked.err.contains("hint: give settings.identify"), "{}", unasked.err);
    for words in [
        "campaign.toml:22: no profile is called \"arduino-txt\"",
        "roll is mapped twice: by device \"potentiometer\" from field 0 (value 0) of port",
        "and by device \"copy\" from field 0 (value 0) of port",
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
    assert!(said.contains("different loads: 1, this curve needs 2 at least"), "{said}");

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

#[test]
fn a_whole_gain_is_taken_through_the_page_of_a_running_daemon() {
    let tank = LiveTank::with_a_cell(4.0);
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("linked", 2);
    let address = daemon.address();
    // 102 counts of nothing and 200 a newton.
    let counts = |load_n: i64| 102 + 200 * load_n;
    let loads = [0, 10, 25, -5].map(|load_n| (load_n, counts(load_n)));
    let (lines, last) =
        loaded(&tank, &["--note", "weights of class M1", "--page", &address], &loads);
    for (line, (load_n, counts)) in lines.iter().zip(loads) {
        assert!(line.starts_with(&format!("load {load_n} N: raw {}", counts / 100)), "{line}");
    }
    assert!(last[0].starts_with("force of cell: zero 10"), "{last:?}");
    assert!(last[1].contains("systemctl reload"), "{last:?}");

    tank.load_counts.store(counts(12), Ordering::Relaxed);
    daemon.signal("-HUP");
    daemon.wait_for("session begun", 2);
    let force = |status: &str| -> Option<f64> {
        let status: serde_json::Value = serde_json::from_str(status).ok()?;
        status["devices"][1]["channels"][0]["value"].as_f64()
    };
    let reads =
        || force(&get(&address, "/status", &[]).body).is_some_and(|n| (n - 12.0).abs() < 0.1);
    daemon.wait_until("12 N are read as 12 N", reads);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let files = tank.files("live", ".mcap");
    assert_eq!(files.len(), 2, "{said}");
    let mut recorded = replay::Recorded::open(&files[1]).expect("it is whole");
    let (mut taken, mut forces) = (None, Vec::new());
    while let Some(record) = recorded.next_record().expect("it can be read") {
        match record {
            replay::Record::Calibration(of) if of.channel == "force" => taken = Some(of),
            replay::Record::Sample(of) if of.quantity == Quantity::Force => forces.push(of.value),
            _ => {}
        }
    }
    let taken = taken.expect("the recording carries it");
    assert!(taken.by == "B. Olsen" && taken.taken.ends_with("UTC"), "{taken:?}");
    let curve: Calibration = toml::from_str(&taken.definition).expect("TOML");
    assert_eq!(curve.note, "weights of class M1");
    assert!((curve.zero_raw - 102.0).abs() < 1.0, "{curve:?}");
    let Curve::Gain(gain) = curve.curve else { panic!("{curve:?}") };
    assert!((200.0 * gain - 1.0).abs() < 1e-3, "{gain}");
    let mean = forces.iter().sum::<f64>() / forces.len() as f64;
    assert!((mean - 12.0).abs() < 0.05, "{mean} N of {} samples", forces.len());
}

#[test]
fn a_cell_that_bends_is_calibrated_by_a_polynomial_and_by_a_table() {
    let tank = LiveTank::with_a_cell(4.0);
    let counts = |load_n: i64| 102 + 200 * load_n - load_n * load_n / 2;
    let loads = [-20, -10, 0, 10, 25].map(|load_n| (load_n, counts(load_n)));
    let with = |curve: &[&str]| {
        let (_, last) = loaded(&tank, &[curve, &["--seconds", "0.4"]].concat(), &loads);
        let taken = tank.text("calibrations.toml");
        let taken: toml::Table = toml::from_str(&taken).expect("TOML");
        let newest = taken["calibration"].as_array().expect("a list").last().expect("one").clone();
        let curve: Curve = newest["curve"].clone().try_into().expect("a curve");
        let zero_raw = newest["zero_raw"].as_float().expect("a number");
        (curve, zero_raw, last.concat())
    };
    let off = |curve: &Curve, zero_raw: f64, load_n: i64| {
        (curve.value(counts(load_n) as f64 - zero_raw) - load_n as f64).abs()
    };
    let (line, zero_raw, said) = with(&["--curve", "gain"]);
    assert!(off(&line, zero_raw, -20) > 0.3 && said.contains("off the loads by "), "{said}");
    let (cubic, zero_raw, said) = with(&["--curve", "polynomial", "--degree", "3"]);
    assert!(matches!(cubic, Curve::Polynomial(_)) && said.contains("off the loads by "), "{said}");
    // A load between those applied is read right, too.
    for load_n in [-20, -15, -4, 0, 6, 18, 25] {
        assert!(off(&cubic, zero_raw, load_n) < 0.03, "{load_n} N, {zero_raw}: {cubic:?}");
    }
    let (table, zero_raw, said) = with(&["--curve", "table"]);
    assert!(said.contains("as few loads fit any such curve"), "{said}");
    for (load_n, _) in loads {
        assert!(off(&table, zero_raw, load_n) < 0.02, "{load_n} N, {zero_raw}: {table:?}");
    }

    tank.load_counts.store(counts(-10), Ordering::Relaxed);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    let reads = || {
        let status = get(&address, "/status", &[]).body;
        let status: serde_json::Value = serde_json::from_str(&status).unwrap_or_default();
        let value = status["devices"][1]["channels"][0]["value"].as_f64();
        value.is_some_and(|force_n| (force_n + 10.0).abs() < 0.1)
    };
    daemon.wait_until("-10 N are read as -10 N by the table", reads);
    daemon.terminate();
}
