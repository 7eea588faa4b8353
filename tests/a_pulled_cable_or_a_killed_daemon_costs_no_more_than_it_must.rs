//! Cables are pulled and put back, the daemon is killed: what was measured stays, the rest is told.

use std::path::Path;
use std::time::{Duration, Instant};

use devices::Quantity;
use devices::emulator::Fault;
use replay::{ExitStatus, Gap, LossKind, Record, Recorded, RunStart, RunStop};

use super::campaign_folder::rolltank;
use super::live_tank::{B1_PER_S, Daemon, LiveTank, RELEASED_S};

/// Every record of the tank's only recording.
fn records(tank: &LiveTank) -> Vec<Record> {
    let files = tank.files("live", ".mcap");
    let [file] = &files[..] else { panic!("{files:?}") };
    records_of(file)
}

fn records_of(file: &Path) -> Vec<Record> {
    let mut recorded = Recorded::open(file).expect("it is whole");
    std::iter::from_fn(|| recorded.next_record().expect("it can be read")).collect()
}

fn gaps(records: &[Record]) -> Vec<&Gap> {
    let gaps = records.iter().filter_map(|record| match record {
        Record::Gap(gap) => Some(gap),
        _ => None,
    });
    gaps.collect()
}

/// Ends of runs, but of what began like one and became none.
fn stops(records: &[Record]) -> Vec<&RunStop> {
    let stops = records.iter().filter_map(|record| match record {
        Record::RunStop(stop) if stop.exit_status != ExitStatus::Fail => Some(stop),
        _ => None,
    });
    stops.collect()
}

fn starts(records: &[Record]) -> Vec<&RunStart> {
    let starts = records.iter().filter_map(|record| match record {
        Record::RunStart(start) => Some(start),
        _ => None,
    });
    starts.collect()
}

/// Whatever began like a run is told to have ended, once, as a run or as none, with a reason.
fn assert_each_ends_once(records: &[Record]) {
    let mut open: Vec<&str> = Vec::new();
    for record in records {
        match record {
            Record::RunStart(start) => {
                assert!(!open.contains(&&*start.run), "{start:?}");
                open.push(&start.run);
            }
            Record::RunStop(stop) => {
                let begun = open.iter().position(|run| *run == stop.run);
                open.remove(begun.unwrap_or_else(|| panic!("it never began: {stop:?}")));
                assert!(!stop.reason.is_empty() && stop.end_s >= stop.start_s, "{stop:?}");
            }
            _ => {}
        }
    }
    assert!(open.is_empty(), "no end is told of {open:?}");
}

#[test]
#[expect(clippy::disallowed_methods, reason = "how fast a loss is told is what it is about")]
fn a_cable_pulled_during_a_decay_ends_the_run_there_and_one_put_back_is_taken_up_again() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("linked", 2);
    tank.sleep_until_in_round(RELEASED_S + 7.0);
    let pulled = Instant::now();
    tank.port(0).unplug();
    daemon.wait_for("link lost", 1);
    let told = pulled.elapsed();
    // The run that was cut is reported while the cable is out.
    daemon.wait_for("latency_s=", 1);
    tank.port(1).unplug();
    // The diagnosis of that run and its report have their time first, however busy the machine is;
    // between the two it is quiet for a moment.
    let mut n_quiet = 0;
    for _ in 0..40 {
        let before_s = daemon.cpu_s();
        std::thread::sleep(Duration::from_millis(500));
        n_quiet = if daemon.cpu_s() - before_s < 0.02 { n_quiet + 1 } else { 0 };
        if n_quiet == 4 {
            break;
        }
    }
    let (before_s, before_wakes) = (daemon.exact_cpu_s(), daemon.wakes());
    std::thread::sleep(Duration::from_secs(5));
    let share = (daemon.exact_cpu_s() - before_s) / 5.0;
    let wakes_per_s = (daemon.wakes() - before_wakes) / 5.0;
    let put_back = Instant::now();
    tank.port(0).replug();
    daemon.wait_for("linked", 3);
    let back = put_back.elapsed();
    tank.port(1).replug();
    println!(
        "told after {told:?}, back after {back:?}, away {:.2} % CPU and {wakes_per_s} wakes/s",
        100.0 * share
    );
    assert!(told < Duration::from_secs(1), "{told:?}");
    assert!(back < Duration::from_secs(3), "{back:?}");
    // A port that is away is tried five times a second; looking every few milliseconds shows here,
    // also on a machine whose wakes cost little.
    assert!(wakes_per_s < 300.0, "{wakes_per_s}");
    assert!(share < 0.01, "{share}");
    daemon.wait_for("latency_s=", 2);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");

    let records = records(&tank);
    assert_each_ends_once(&records);
    let gaps = gaps(&records);
    let roll = gaps.iter().find(|gap| gap.channel == "roll").expect("a gap was recorded");
    assert!(roll.reason.contains("link was lost"), "{roll:?}");
    assert!(roll.end_s - roll.start_s > 10.0 && roll.lost.is_some_and(|lost| lost > 1000));
    let stops = stops(&records);
    assert_eq!(stops[0].reason, "the record had a hole", "{stops:?}");
    assert!((stops[0].end_s - roll.start_s).abs() < 0.5, "{stops:?}");
    assert_eq!(stops[0].exit_status, ExitStatus::Abort, "{stops:?}");
    let starts = starts(&records);
    let start = starts.iter().find(|start| start.run == stops[0].run).expect("it began");
    // Before it ended, it was told to have begun.
    assert!(start.time_s < stops[0].end_s, "{start:?} {stops:?}");

    let live = tank.text("results/identification.json");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    // Data were lost, and the replay says so with its exit code.
    assert_eq!(replayed.exit, 3, "{}", replayed.err);
    assert_eq!(replayed.out, live, "{said}");
}

#[test]
fn samples_that_fail_within_a_run_are_masked_and_counted() {
    let tank = LiveTank::at_speed(8.0);
    // A day may begin before everything is plugged in.
    tank.port(0).unplug();
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("does not exist", 1);
    tank.port(0).replug();
    daemon.wait_for("linked", 2);
    tank.sleep_until_in_round(RELEASED_S + 5.0);
    for fault in [Fault::Skip(5), Fault::Repeat(3), Fault::Noise(20)] {
        tank.port(0).fault(fault);
        std::thread::sleep(Duration::from_millis(60));
    }
    daemon.wait_for("latency_s=", 1);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let records = records(&tank);
    assert_each_ends_once(&records);
    let stops = stops(&records);
    let roll = stops[0].counts.iter().find(|counts| counts.channel == "roll").expect("roll");
    assert!(roll.lost >= 5 && roll.repeated == 3 && roll.damaged >= 1, "{roll:?}");
    assert!(roll.samples > 1000, "{roll:?}");
    let live = tank.text("results/identification.json");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
    let live: serde_json::Value = serde_json::from_str(&live).expect("JSON");
    let run = &live["runs"][0];
    let counts = serde_json::to_value(&stops[0].counts).expect("JSON");
    assert_eq!(run["counts"], counts, "the results tell what the recording does");
    let page = tank.text(&format!("results/run-{}.html", run["id"].as_str().expect("an id")));
    let row = format!("<td>roll</td><td class=\"number\">{}</td>", roll.samples);
    assert!(page.contains(&row) && page.contains("What the instruments brought"), "{row}");
    assert!(run["end_s"].as_f64() > run["start_s"].as_f64().map(|start_s| start_s + 10.0));
    let mean = run["b1_per_s"]["mean"].as_f64().expect("b1");
    assert!((mean - B1_PER_S).abs() < 0.1, "{run}");
}

#[test]
fn an_over_driven_instrument_is_masked_and_counted_and_ends_the_run() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("linked", 2);
    tank.sleep_until_in_round(RELEASED_S + 8.0);
    tank.port(0).fault(Fault::Saturate(true));
    std::thread::sleep(Duration::from_millis(300));
    tank.port(0).fault(Fault::Saturate(false));
    daemon.wait_for("latency_s=", 1);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let records = records(&tank);
    assert_each_ends_once(&records);
    let n_over_range: u64 = records
        .iter()
        .map(|record| match record {
            Record::Loss(loss) if loss.kind == LossKind::OverRange => loss.count,
            _ => 0,
        })
        .sum();
    assert!(n_over_range > 100, "{n_over_range}");
    // Sample by sample the recording tells which ones.
    let (mut flags, mut n_flagged) = (String::new(), 0);
    for record in &records {
        match record {
            Record::Quality(change) if change.channel == "roll" => flags.clone_from(&change.flags),
            Record::Sample(sample) if sample.quantity == Quantity::Roll => {
                n_flagged += u64::from(flags.contains("over range"));
            }
            _ => {}
        }
    }
    assert_eq!((n_flagged, flags.contains("over range")), (n_over_range, false));
    let stops = stops(&records);
    assert_eq!(stops[0].reason, "the record had a hole", "{stops:?}");
    let live = tank.text("results/identification.json");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
}

#[test]
fn a_killed_daemon_leaves_what_it_recorded_and_the_next_keeps_the_runs() {
    let tank = LiveTank::at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("latency_s=", 1);
    // The page of the run is there at once, the campaign's follows.
    assert!(!tank.files("results", ".html").is_empty());
    daemon.wait_until("campaign's page", || tank.files("results", "index.html").len() == 1);
    tank.sleep_until_in_round(RELEASED_S + 8.0);
    daemon.kill();
    assert_eq!(tank.files("live", ".mcap.part").len(), 1);

    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("recovered", 1);
    // The run before the kill, the one that it cut, and one of the new recording.
    daemon.wait_for("latency_s=", 2);
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let files = tank.files("live", ".mcap");
    assert_eq!(files.len(), 2, "{said}");
    let recovered = Recorded::open(&files[0]).expect("it is whole");
    assert_eq!(recovered.metadata()["exit_status"], "recovered");
    let records = records_of(&files[0]);
    assert_each_ends_once(&records);
    let (starts, stops) = (starts(&records), stops(&records));
    let cut = stops.last().expect("the run that was cut");
    assert_eq!((&cut.run, cut.exit_status), (&starts[starts.len() - 1].run, ExitStatus::Recovered));
    let whole = stops.iter().find(|stop| stop.exit_status == ExitStatus::Success);
    assert!(whole.is_some_and(|whole| whole.end_s < cut.start_s), "{stops:?}");
    let live = tank.text("results/identification.json");
    let results: serde_json::Value = serde_json::from_str(&live).expect("JSON");
    let recordings: Vec<&str> = results["runs"]
        .as_array()
        .expect("runs")
        .iter()
        .filter_map(|run| run["recording"].as_str())
        .collect();
    assert!(recordings.len() >= 3, "{recordings:?}");
    assert_eq!(recordings[0], recordings[1]);
    assert_ne!(recordings[1], recordings[2]);
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
}
