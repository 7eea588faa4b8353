//! Samples of streams without a sequence number are missed too, and no jitter is taken for a loss.

use devices::driver::Session;
use devices::emulator::{Fault, Faults, emulator};
use devices::port::LinkEvent;
use devices::setup::DeviceConfig;
use devices::{InstrumentEvent, Interpreter};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::bench::{channels, device, swing};

const MS: u64 = 1_000_000;
const LATENCY_S: f64 = 0.016;
/// When the fault is commanded [ms].
const SKIPPED_MS: u64 = 60_000;

/// The raw record of two minutes behind an adapter's timer, on a host that is busy now and then.
fn record(config: &DeviceConfig, rate_hz: f64, n_skipped: u64) -> Vec<LinkEvent> {
    // Instruments print a few digits, not seventeen.
    let signal = Box::new(|field, time_s| swing(field, time_s).round());
    let mut board =
        emulator(&config.driver, &config.settings, rate_hz, signal).expect("the settings are good");
    let random = &mut ChaCha8Rng::seed_from_u64(3);
    let mut faults = Faults::default();
    let mut links = vec![LinkEvent::Opened { at_ns: 0 }];
    let (mut bytes, mut blocked_until_ms) = (Vec::new(), 0);
    for now_ms in 0..120_000_u64 {
        if now_ms == SKIPPED_MS {
            faults.command(Fault::Skip(n_skipped));
        }
        board.tick(now_ms as f64 * 1e-3, &mut faults, &mut bytes);
        if random.random_bool(0.0005) {
            blocked_until_ms = now_ms + random.random_range(50..200);
        }
        if now_ms % 16 != 0 || now_ms < blocked_until_ms || bytes.is_empty() {
            continue;
        }
        let at_ns = now_ms * MS + random.random_range(0..MS);
        let bytes = std::mem::take(&mut bytes);
        links.push(LinkEvent::Received { at_ns, bytes, decoded: Vec::new() });
    }
    links
}

/// What the record means to a fresh session and interpreter, and how many samples it says are lost.
fn meaning(config: &DeviceConfig, links: &[LinkEvent]) -> (Vec<InstrumentEvent>, u64) {
    let pace = config.pace.pace(&config.line);
    let mut session = Session::new(config.protocol().expect("good settings"), pace);
    let mut interpreter = Interpreter::new(config, LATENCY_S).expect("good settings");
    let mut events = Vec::new();
    for link in links {
        interpreter.replay(link, &mut session, &mut events);
    }
    let lost = interpreter.counts().map(|(_, counts)| counts.lost).sum();
    (events, lost)
}

/// Every gap: its ends [s], and how many samples are missing in it.
fn gaps(events: &[InstrumentEvent]) -> Vec<(f64, f64, Option<u64>)> {
    let gap = |event: &InstrumentEvent| match event {
        InstrumentEvent::Gap { from_s, to_s, n_missing } => Some((*from_s, *to_s, *n_missing)),
        _ => None,
    };
    events.iter().filter_map(gap).collect()
}

/// Streams without a sequence number: by arrivals alone, and by the instrument's own time.
fn streams() -> [(&'static str, &'static str, f64); 5] {
    let stamped = "settings = { pattern = \"{time_us},{0}\" }\n";
    let turning = "settings = { pattern = \"{time_ms},{0}\", time_bits = 16 }\n";
    [
        ("nmea-speed-log", "", 10.0),
        ("scale-continuous", "", 40.0),
        ("scale-continuous", "settings = { pattern = \"{0}\" }\n", 100.0),
        ("arduino-text", stamped, 200.0),
        ("arduino-text", turning, 50.0),
    ]
}

#[test]
fn skipped_samples_are_counted_where_they_are_missing() {
    for (profile, settings, rate_hz) in streams() {
        let (_folder, config) = device(profile, &format!("{settings}{}", channels(1)));
        let (events, lost) = meaning(&config, &record(&config, rate_hz, 4));
        assert_eq!(lost, 4, "{profile} {settings}");
        let gaps = gaps(&events);
        let [(from_s, to_s, n_missing)] = gaps[..] else { panic!("{profile}: {gaps:?}") };
        assert_eq!(n_missing, Some(4), "{profile}");
        let skipped_s = SKIPPED_MS as f64 * 1e-3;
        let until_s = skipped_s + 5.0 / rate_hz;
        assert!((from_s - skipped_s).abs() < 0.25, "{profile}: {from_s} to {to_s} s");
        assert!(to_s > from_s && (to_s - until_s).abs() < 0.25, "{profile}: {from_s} to {to_s} s");
    }
}

#[test]
fn a_busy_host_behind_a_slow_adapter_is_not_taken_for_a_loss() {
    for (profile, settings, rate_hz) in streams() {
        let (_folder, config) = device(profile, &format!("{settings}{}", channels(1)));
        let (events, lost) = meaning(&config, &record(&config, rate_hz, 0));
        assert_eq!((lost, gaps(&events)), (0, Vec::new()), "{profile} {settings}");
        let n_samples = events.iter().filter(|event| event.usable_sample().is_some()).count();
        assert!(n_samples as f64 > 119.0 * rate_hz, "{profile}: {n_samples}");
    }
}

#[test]
fn a_line_that_is_sent_twice_with_one_time_is_one_sample() {
    let settings = "settings = { pattern = \"{time_us},{0}\" }\n";
    let (_folder, config) = device("arduino-text", &format!("{settings}{}", channels(1)));
    let line = |index: u64| format!("{},{index}\r\n", 10_000 * index).into_bytes();
    let twice = (0..40).map(|index| if index == 30 { line(index).repeat(2) } else { line(index) });
    let received = twice.enumerate().map(|(index, bytes)| {
        let at_ns = 10 * MS * index as u64 + MS;
        LinkEvent::Received { at_ns, bytes, decoded: Vec::new() }
    });
    let links: Vec<LinkEvent> =
        std::iter::once(LinkEvent::Opened { at_ns: 0 }).chain(received).collect();
    let (events, lost) = meaning(&config, &links);
    let samples = events.iter().filter_map(InstrumentEvent::usable_sample);
    assert_eq!((samples.count(), lost), (40, 0));
}
