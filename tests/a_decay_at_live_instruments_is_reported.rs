//! The daemon attaches, records, finds a decay, identifies it, and leaves everything whole.

use super::campaign_folder::rolltank;
use super::http::get;
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
fn what_a_decay_says_is_told_before_its_end_is_known_and_replaced_by_what_it_says_then() {
    // At the pace of the world: however busy the machine, its second is the tank's.
    let tank = LiveTank::at_speed(1.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    let [numbers, page] = ["results/provisional.json", "results/run-provisional.html"];
    let told = || tank.text(numbers).contains("under way") && !tank.text(page).is_empty();
    daemon.wait_until("something provisional is told", told);
    let (so_far, shown) = (identification(&tank.text(numbers)), tank.text(page));
    let state = get(&address, "/status", &[]).body;
    let served = get(&address, "/results/run-provisional.html", &[]);
    assert!(!daemon.said().contains("run found"), "its end was known: {}", daemon.said());
    assert_eq!(so_far["schema"], "rolltank.provisional/1");
    let run = &so_far["identification"]["runs"][0];
    assert_eq!((&run["id"], &run["kind"]), (&"provisional".into(), &"decay".into()), "{run}");
    assert!(run["b1_per_s"]["mean"].as_f64().is_some_and(|b1| b1 > 0.1), "{run}");
    assert!(shown.contains("Provisional: the run is still under way"), "the page says so");
    assert!(state.contains("\"free decay, Fr 0.000,"), "{state}");
    assert!(served.status == 200 && served.body.contains("Provisional"), "{served:?}");

    // What is told follows the run; how soon after its last sample, `rolltank bench live` says.
    let [begun_s, ends_s] = ["start_s", "end_s"].map(|key| run[key].as_f64().expect(key));
    let told_to_s = || {
        let told: serde_json::Value = serde_json::from_str(&tank.text(numbers)).unwrap_or_default();
        told["identification"]["runs"][0]["end_s"].as_f64().unwrap_or(f64::NAN)
    };
    daemon.wait_until("seconds more of it are told", || told_to_s() > ends_s + 4.0);
    assert!(!daemon.said().contains("run found"), "its end was known: {}", daemon.said());

    daemon.wait_for("first_after_s=", 1);
    let results = || tank.text("results/identification.json");
    let of_it = |text: &str| {
        let told: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
        told["identification"]["runs"][0]["start_s"].as_f64().is_some_and(|s| s < begun_s + 10.0)
    };
    // At no time is nothing told of it.
    daemon.wait_until("the results hold it", || {
        let is_told = of_it(&tank.text(numbers));
        let is_held = results().contains("start_s");
        assert!(is_told || is_held, "neither provisional nor final");
        is_held
    });
    daemon.wait_until("what was told before is gone", || !of_it(&tank.text(numbers)));
    let found = identification(&results());
    let last = &found["runs"][0];
    assert_ne!(last["id"], "provisional");
    assert!((last["start_s"].as_f64().expect("a start") - begun_s).abs() < 1.0, "{last}");
    assert!(last["end_s"].as_f64().expect("an end") > ends_s, "{last}");

    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    assert!(tank.text(numbers).is_empty() && tank.text(page).is_empty(), "nothing is left of it");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, tank.text("results/identification.json"), "{said}");
}

#[test]
fn a_long_day_is_several_recordings_that_follow_each_other_at_rests() {
    let tank = LiveTank::calm_at_speed(20.0);
    let mut daemon = Daemon::start(&tank, &["--rotate", "0.6"]);
    daemon.wait_for("session begun", 3);
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
