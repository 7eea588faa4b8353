//! Nothing is recorded, somebody lets the model go and then sees it: the run is in the recording.

use std::path::Path;

use replay::{LossKind, Record, Recorded};

use super::campaign_folder::rolltank;
use super::http::post;
use super::live_tank::{Daemon, LiveTank, RELEASED_S};

/// When somebody stops the recording, and when they want it again, in the tank's round [s].
const STOPPED_S: f64 = 1.0;
const WANTED_S: f64 = RELEASED_S + 5.0;
/// Roll samples are nowhere further apart [s].
const APART_S: f64 = 0.1;

fn act(address: &str, what: &str) {
    let wish = format!("{{\"by\": \"C. Costa\", \"what\": \"{what}\"}}");
    let answer = post(address, "/act", &[], &wish);
    assert_eq!(answer.status, 200, "{what}: {}", answer.body);
}

/// Times of the roll in a recording [s], and samples lost of any channel.
fn rolls(recording: &Path) -> (Vec<f64>, u64) {
    let mut recorded = Recorded::open(recording).expect("it is whole");
    let (mut times_s, mut n_lost) = (Vec::new(), 0);
    while let Some(record) = recorded.next_record().expect("it can be read") {
        match record {
            Record::Sample(sample) if sample.quantity.name() == "roll" => {
                times_s.push(sample.time_s);
            }
            Record::Gap(gap) => panic!("{gap:?}"),
            Record::Loss(loss) if loss.kind == LossKind::Lost => n_lost += loss.count,
            _ => {}
        }
    }
    (times_s, n_lost)
}

#[test]
fn a_model_let_go_before_the_recording_was_wanted_is_recorded_from_before_and_identified() {
    let tank = LiveTank::at_speed(4.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_for("linked", 2);
    tank.sleep_until_in_round(STOPPED_S);
    act(&address, "stop_recording");
    daemon.wait_for("session begun", 2);
    tank.sleep_until_in_round(WANTED_S);
    act(&address, "start_recording");
    daemon.wait_for("latency_s=", 1);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(said.matches("linked").count(), 2, "its ports stayed open: {said}");

    let recordings = tank.files("live", ".mcap");
    let [before, after] = &recordings[..] else { panic!("{recordings:?}: {said}") };
    let (earlier_s, _) = rolls(before);
    let (times_s, n_lost) = rolls(after);
    assert_eq!(n_lost, 0, "{said}");
    assert!(earlier_s.last() < times_s.first(), "no sample is in both");
    for pair in times_s.windows(2) {
        assert!(pair[0] < pair[1] && pair[1] - pair[0] < APART_S, "{pair:?}");
    }
    let live = tank.text("results/identification.json");
    let runs: serde_json::Value = serde_json::from_str(&live).expect("the contract");
    let run = &runs["runs"][0];
    let begins_s = run["start_s"].as_f64().expect("a run");
    let recorded_before_s = begins_s - times_s[0];
    println!("recorded since {recorded_before_s:.1} s before the release");
    assert!((5.0..WANTED_S).contains(&recorded_before_s), "{recorded_before_s} s: {said}");
    let length_s = run["end_s"].as_f64().expect("an end") - begins_s;
    assert!(length_s > WANTED_S - RELEASED_S + 2.0, "one run, not two halves: {run}");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
}
