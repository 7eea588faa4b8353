//! The raw record of a link, through a fresh driver, gives what was live, to the bit.

use devices::channel::Counts;
use devices::driver::Session;
use devices::emulator::Fault;
use devices::port::LinkEvent;
use devices::{InstrumentEvent, Interpreter};

use crate::bench::{bench, channels};

/// What a recording keeps of a link: times and bytes, nothing decoded.
fn raw(link: &LinkEvent) -> Option<LinkEvent> {
    let decoded = Vec::new();
    match link.clone() {
        LinkEvent::Sent { at_ns, bytes, .. } => Some(LinkEvent::Sent { at_ns, bytes, decoded }),
        LinkEvent::Received { at_ns, bytes, .. } => {
            Some(LinkEvent::Received { at_ns, bytes, decoded })
        }
        LinkEvent::Waited { at_ns, .. } => Some(LinkEvent::Waited { at_ns, decoded }),
        LinkEvent::Opened { .. } | LinkEvent::Lost { .. } => Some(link.clone()),
        _ => None,
    }
}

fn lasting(events: &[InstrumentEvent]) -> Vec<InstrumentEvent> {
    let told = |event: &&InstrumentEvent| !matches!(event, InstrumentEvent::Trouble(_));
    events.iter().filter(told).cloned().collect()
}

/// What the first channel counted, live and replayed.
fn replay_equals_live(profile: &str, lines: &str) -> Counts {
    let mut bench = bench(profile, lines, 200.0);
    bench.listen_until(|bench| bench.n_samples() >= 40);
    for fault in [Fault::Skip(3), Fault::Noise(30), Fault::Repeat(2), Fault::Saturate(true)] {
        bench.port.fault(fault);
        bench.listen_for(0.1);
    }
    bench.port.unplug();
    bench.listen_for(0.1);
    bench.port.replug();
    let n_samples = bench.n_samples();
    bench.listen_until(|bench| bench.n_samples() >= n_samples + 20);

    let pace = bench.config.pace.pace(&bench.config.line);
    let mut session = Session::new(bench.config.protocol().expect("the settings are good"), pace);
    let mut interpreter = Interpreter::new(&bench.config, bench.instrument.latency_s())
        .expect("the settings are good");
    let mut replayed = Vec::new();
    for link in bench.links.iter().filter_map(raw) {
        interpreter.replay(&link, &mut session, &mut replayed);
    }
    assert_eq!(lasting(&replayed), lasting(&bench.events), "{profile}");
    assert!(interpreter.counts().eq(bench.instrument.counts()), "{profile}");
    let (_, counts) = interpreter.counts().next().expect("it has a channel");
    counts
}

#[test]
fn a_stream_is_replayed() {
    replay_equals_live("cobs-board", &channels(2));
}

#[test]
fn a_bus_that_is_asked_is_replayed() {
    replay_equals_live(
        "mantracourt-dsc",
        &format!("settings = {{ stations = [1, 2] }}\n{}", channels(2)),
    );
}

#[test]
fn modules_with_check_sums_are_replayed() {
    let settings =
        "modules = [{ address = 1 }, { address = 2 }], checksum = true, synchronised = true";
    let lines =
        format!("settings = {{ {settings} }}\npace = {{ timeout_s = 0.05 }}\n{}", channels(2));
    replay_equals_live("adam-4017", &lines);
}

#[test]
fn a_binary_stream_without_a_sequence_is_replayed() {
    replay_equals_live("hbm-ad104-binary", &channels(1));
}

#[test]
fn lines_with_a_time_and_no_sequence_are_replayed() {
    let settings = "settings = { pattern = \"{time_us},{0}\" }\n";
    let counts = replay_equals_live("arduino-text", &format!("{settings}{}", channels(1)));
    // The board's own time tells how many it sent while the cable was out as well.
    assert!(counts.lost > 3 + 20 && counts.repeated == 2, "{counts:?}");
}

#[test]
fn lines_without_any_number_are_replayed() {
    replay_equals_live("scale-continuous", &channels(1));
}
