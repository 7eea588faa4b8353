//! An unplugged instrument is told at once, costs nothing while away, and comes back by itself.

use std::sync::Arc;
use std::time::Duration;

use devices::clock::Clock;
use devices::emulator::Fault;
use devices::{InstrumentEvent, Measured};

use crate::bench::{Bench, bench, channels};

fn lines() -> String {
    format!("[settings]\nfields = 1\n{}", channels(1))
}

fn lost_ns(bench: &Bench) -> Option<u64> {
    bench.events.iter().find_map(|event| match event {
        InstrumentEvent::LinkLost { at_ns, .. } => Some(*at_ns),
        _ => None,
    })
}

fn last_linked_ns(bench: &Bench) -> u64 {
    let linked = bench.events.iter().rev().find_map(|event| match event {
        InstrumentEvent::Linked { at_ns } => Some(*at_ns),
        _ => None,
    });
    linked.expect("the link was up")
}

/// CPU time of this process [s], all threads.
fn cpu_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("Linux tells it");
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(11).take(2);
    ticks.map(|ticks| ticks.parse::<f64>().expect("a count")).sum::<f64>() / 100.0
}

#[test]
fn a_pulled_cable_is_told_within_a_tenth_of_a_second_and_a_replugged_one_is_back_in_one() {
    let mut worst_lost_ms: f64 = 0.0;
    let mut worst_back_ms: f64 = 0.0;
    for _ in 0..3 {
        let mut bench = bench("cobs-board", &lines(), 200.0);
        bench.listen_until(|bench| bench.n_samples() >= 50);
        let before = bench.samples().last().copied().unwrap();
        let pulled_ns = bench.clock.now_ns();
        bench.port.unplug();
        bench.listen_until(|bench| lost_ns(bench).is_some());
        let lost_ms = (lost_ns(&bench).unwrap() - pulled_ns) as f64 * 1e-6;
        worst_lost_ms = worst_lost_ms.max(lost_ms);
        bench.listen_for(0.5);
        let told = bench.troubles();
        assert!(told.iter().any(|told| told.contains("does not exist")), "{told:?}");
        assert_eq!(told.len(), 1, "told once: {told:?}");
        let back_ns = bench.clock.now_ns();
        bench.port.replug();
        let n_samples = bench.n_samples();
        bench.listen_until(|bench| bench.n_samples() > n_samples + 20);
        worst_back_ms = worst_back_ms.max((last_linked_ns(&bench) - back_ns) as f64 * 1e-6);
        check_gap(&bench, &before);
    }
    println!("loss told after {worst_lost_ms:.1} ms, back after {worst_back_ms:.0} ms, at worst");
    assert!(worst_lost_ms <= 100.0, "{worst_lost_ms} ms");
    assert!(worst_back_ms <= 1000.0, "{worst_back_ms} ms");
}

/// The gap says from when to when, and how many samples, since the board counted on.
fn check_gap(bench: &Bench, before: &Measured) {
    let gap = bench.events.iter().find_map(|event| match event {
        InstrumentEvent::Gap { from_s, to_s, n_missing } => Some((*from_s, *to_s, *n_missing)),
        _ => None,
    });
    let (from_s, to_s, n_missing) = gap.expect("a gap was told");
    let n_missing = n_missing.expect("the board counts") as f64;
    assert!(from_s >= before.sample.time_s && to_s > from_s + 0.4, "{from_s} to {to_s}");
    let expected = (to_s - from_s) * 200.0 - 1.0;
    assert!((n_missing - expected).abs() < 6.0, "{n_missing} missing, not {expected}");
    let samples = bench.samples();
    assert!(samples.windows(2).all(|two| two[0].sample.time_s < two[1].sample.time_s));
}

#[test]
fn a_missing_port_floods_nobody() {
    let mut bench = bench("cobs-board", &lines(), 1.0);
    bench.listen_until(|bench| !bench.links.is_empty());
    bench.port.unplug();
    bench.listen_until(|bench| lost_ns(bench).is_some());
    let n_links = bench.links.len();
    // The emulator's own thread runs in this process too, and idles as little as ours.
    std::thread::sleep(Duration::from_secs(2));
    bench.listen_for(0.05);
    assert!(bench.links.len() - n_links <= 2, "{:?}", &bench.links[n_links..]);
}

#[test]
fn another_adapter_under_the_same_name_is_noticed() {
    let mut bench = bench("cobs-board", &lines(), 200.0);
    bench.listen_until(|bench| bench.n_samples() >= 20);
    // The board falls silent, and its name now leads elsewhere: a stale handle would wait for ever.
    bench.port.fault(Fault::Mute(true));
    let path = bench.port_path();
    std::fs::remove_file(&path).unwrap();
    std::os::unix::fs::symlink("/dev/null", &path).unwrap();
    let moved_ns = bench.clock.now_ns();
    bench.listen_until(|bench| lost_ns(bench).is_some());
    let lost_ms = (lost_ns(&bench).unwrap() - moved_ns) as f64 * 1e-6;
    assert!(lost_ms <= 100.0, "{lost_ms} ms");
    bench.listen_for(0.3);
    let told = bench.troubles();
    assert!(told.iter().any(|told| told.contains("is no serial port")), "{told:?}");
}

#[test]
fn a_stall_loses_nothing_and_its_samples_keep_their_times() {
    let mut bench = bench("cobs-board", &lines(), 200.0);
    bench.listen_for(2.5);
    bench.port.fault(Fault::Stall(true));
    bench.listen_for(0.3);
    bench.port.fault(Fault::Stall(false));
    bench.listen_for(0.5);
    let (_, counts) = bench.instrument.counts().next().unwrap();
    assert_eq!((counts.lost, counts.damaged), (0, 0), "{counts:?}");
    let samples = bench.samples();
    for two in samples.windows(2) {
        let step_s = two[1].sample.time_s - two[0].sample.time_s;
        assert!(step_s > 0.0 && step_s < 0.02, "{two:?}");
    }
    let clock: &Arc<dyn Clock> = &bench.clock;
    assert!(clock.now_ns() > 0 && samples.len() > 500, "{} samples", samples.len());
}

#[test]
fn a_thread_that_waits_uses_less_than_a_hundredth_of_a_core() {
    // In a process of its own, because the other stories run beside this one.
    let exe = std::env::current_exe().unwrap();
    if std::env::var_os("ROLLTANK_IDLE").is_none() {
        let name = "a_cable_is_pulled_and_put_back::\
                    a_thread_that_waits_uses_less_than_a_hundredth_of_a_core";
        let output = std::process::Command::new(exe)
            .args(["--exact", name, "--nocapture"])
            .env("ROLLTANK_IDLE", "1")
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        print!("{told}");
        assert!(output.status.success(), "{told}");
        return;
    }
    let (_folder, config) = crate::bench::device("cobs-board", &lines());
    let clock = Arc::new(devices::clock::WallClock::start());
    let _instrument = devices::Instrument::start(&config, clock).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let before_s = cpu_s();
    std::thread::sleep(Duration::from_secs(4));
    let share = (cpu_s() - before_s) / 4.0;
    println!("CPU while the port is away: {:.2} %", 100.0 * share);
    assert!(share < 0.01, "{share}");
}
