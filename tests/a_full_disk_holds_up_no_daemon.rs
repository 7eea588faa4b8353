//! A daemon that is started on a full disk shows what comes, tells of the disk, and records when it
//! can.

use std::env;
use std::fs;
use std::path::PathBuf;

use super::campaign_folder::rolltank;
use super::http;
use super::live_tank::{Daemon, LiveTank};

#[path = "../replay/tests/small_disk.rs"]
mod small_disk;

use small_disk::{FOLDER, told_on_a_disk_of};

/// What the disk holds [bytes]: the recorder leaves 64 MiB to others, and begins again at 128 MiB.
const DISK_BYTES: u64 = 192 << 20;
const BALLAST_BYTES: usize = 160 << 20;

#[test]
#[ignore = "run by the story beside it, in a mount namespace of its own"]
fn child_on_the_full_disk() {
    let folder = PathBuf::from(env::var_os(FOLDER).expect("the story names the folder"));
    let ballast = folder.join("ballast");
    fs::write(&ballast, vec![1; BALLAST_BYTES]).expect("it fits");
    // Temporary folders lie on the small disk, by this process's environment.
    let tank = LiveTank::at_speed(8.0);
    assert!(tank.path().starts_with(&folder));
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_for("linked", 2);
    let status = || -> serde_json::Value {
        serde_json::from_str(&http::get(&address, "/status", &[]).body).unwrap_or_default()
    };
    daemon.wait_until("roll on the page", || {
        status()["devices"][0]["channels"][0]["value"].is_number()
    });
    assert_eq!(status()["recorded"]["stopped"], true, "{}", status());
    let ready = http::get(&address, "/readyz", &[]);
    assert!(ready.status == 503 && ready.body.contains("disk is full"), "{ready:?}");
    assert!(tank.files("live", ".part").is_empty(), "{}", daemon.said());

    // Somebody reloads: that changes nothing.
    daemon.signal("-HUP");
    daemon.wait_for("session begun", 2);
    assert_eq!(status()["recorded"]["stopped"], true, "{}", status());

    // Some samples come before there is room.
    let at_s = || status()["at_s"].as_f64().expect("a time");
    let begun_s = at_s();
    daemon.wait_until("samples come", || at_s() > begun_s + 0.5);
    let full_s = at_s();
    fs::remove_file(&ballast).expect("it is there");
    daemon.wait_until("recorded again", || tank.files("live", ".part").len() == 1);
    daemon.wait_until("ready", || http::get(&address, "/readyz", &[]).status == 200);
    daemon.wait_for("latency_s=", 1);

    // Once more, in the middle of the recording: that one ends, and another follows.
    fs::write(&ballast, vec![1; BALLAST_BYTES]).expect("it fits");
    daemon.wait_until("stopped", || http::get(&address, "/readyz", &[]).status == 503);
    fs::remove_file(&ballast).expect("it is there");
    daemon.wait_until("ready again", || http::get(&address, "/readyz", &[]).status == 200);
    daemon.wait_until("recorded again", || tank.files("live", ".part").len() == 1);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let recordings = tank.files("live", ".mcap");
    assert_eq!(recordings.len(), 2, "{said}");
    let mut recorded = replay::Recorded::open(&recordings[0]).expect("it is whole");
    assert_eq!(recorded.metadata()["exit_status"], "abort", "{said}");
    let first_s =
        std::iter::from_fn(|| recorded.next_record().expect("it can be read")).find_map(|record| {
            match record {
                replay::Record::Sample(sample) => Some(sample.time_s),
                _ => None,
            }
        });
    assert!(first_s.is_some_and(|first_s| first_s < full_s), "{first_s:?} and {full_s}: {said}");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    // Only the replay has seen the note of what was lost.
    let without_notes = |text: &str| text.split("\"notes\"").next().map(str::to_owned);
    let live = tank.text("results/identification.json");
    assert!(without_notes(&replayed.out) == without_notes(&live), "{}: {said}", replayed.out);
    assert!(said.contains("not recorded: ") && said.contains("are free"), "{said}");
    assert!(tank.text("results/identification.json").contains("\"b1_per_s\""), "{said}");
    println!("\nfull, then recorded");
}

#[test]
fn a_daemon_started_on_a_full_disk_shows_and_tells_and_records_once_there_is_room() {
    let child = concat!(module_path!(), "::child_on_the_full_disk");
    match told_on_a_disk_of(DISK_BYTES, child) {
        Some(told) => assert!(told.contains("full, then recorded"), "{told}"),
        None => println!("skipped: no tmpfs may be mounted here"),
    }
}
