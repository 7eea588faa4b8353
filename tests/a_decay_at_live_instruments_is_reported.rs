//! The daemon attaches, records, finds a decay, identifies it, and leaves everything whole.

use super::campaign_folder::rolltank;
use super::live_tank::{B1_PER_S, Daemon, LiveTank};

/// The identification that a file of the campaign holds.
fn identification(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_decay_is_identified_as_it_ends_and_again_from_its_raw_bytes_to_the_bit() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("latency_s=", 2);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");

    let recordings = tank.files("live", ".mcap");
    assert_eq!(recordings.len(), 1, "{said}");
    assert!(tank.files("live", ".part").is_empty(), "{said}");
    let live = tank.text("results/identification.json");
    let runs = identification(&live);
    let runs = runs["runs"].as_array().expect("a list of runs");
    assert!(runs.len() >= 2, "{live}");
    for run in runs {
        assert_eq!(run["kind"], "decay", "{run}");
        assert_eq!(run["condition"], "bare hull", "{run}");
        let [low, high] = ["lo95", "hi95"].map(|end| run["b1_per_s"][end].as_f64().expect(end));
        let near = (low - 0.05)..(high + 0.05);
        assert!(near.contains(&B1_PER_S), "b1 from {low} to {high}, not {B1_PER_S}");
        let id = run["id"].as_str().expect("a name");
        assert!(!tank.text(&format!("results/run-{id}.html")).is_empty(), "no page of {id}");
    }

    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.exit, 0, "{}", replayed.err);
    assert_eq!(replayed.out, live, "{said}");
}

#[test]
fn a_long_day_is_several_recordings_that_follow_each_other_at_rests() {
    let tank = LiveTank::calm_at_speed(20.0);
    let mut daemon = Daemon::start(&tank, &["--rotate", "0.6"]);
    daemon.wait_for("linked", 6);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let recordings = tank.files("live", ".mcap");
    assert_eq!(recordings.len(), 3, "{said}");
    assert!(tank.files("live", ".part").is_empty(), "{said}");
    for recording in &recordings {
        let recorded = replay::Recorded::open(recording).expect("it is whole");
        assert_eq!(recorded.metadata()["exit_status"], "success");
    }
    let told = rolltank(tank.path(), &["check", ".", "--seconds", "0.3"]);
    assert!(told.out.contains("live/") && told.out.contains("roll "), "{}", told.out);
}
