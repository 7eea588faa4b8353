//! Whatever the stream, the run finder answers, without panic, without NaN, and however it is cut.

use devices::{Quantity, Sample};
use proptest::prelude::*;
use rolltank::run::{Event, RunFinder, Series};

use super::run_finding_scene::LIMITS;

/// The events of a stream fed in one go, without its end.
fn events_of(samples: &[Sample]) -> Vec<Event> {
    let mut finder = RunFinder::new(LIMITS);
    let mut events = Vec::new();
    for sample in samples {
        finder.push(sample, &mut events);
    }
    events
}

/// The events of a stream fed in chunks of these lengths, over and over, with its end.
fn events_in_chunks(samples: &[Sample], lengths: &[usize]) -> Vec<Event> {
    let mut finder = RunFinder::new(LIMITS);
    let mut all = Vec::new();
    let (mut rest, mut lengths) = (samples, lengths.iter().cycle());
    while !rest.is_empty() {
        let length = lengths.next().map_or(1, |&n| n.clamp(1, rest.len()));
        let mut events = Vec::new();
        for sample in &rest[..length] {
            finder.push(sample, &mut events);
        }
        all.append(&mut events);
        rest = &rest[length..];
    }
    finder.finish(&mut all);
    all
}

fn is_sound(series: &Series, start_s: f64, end_s: f64) -> bool {
    series.time_s.len() == series.value.len()
        && series.time_s.is_sorted()
        && series.time_s.iter().all(|t| (start_s..=end_s).contains(t))
        && series.value.iter().all(|v| v.is_finite())
}

/// Nothing in an event may be NaN or out of order.
fn assert_sound(events: &[Event]) {
    for event in events {
        match event {
            Event::Run(run) => {
                assert!(run.start_s <= run.end_s && run.end_s.is_finite());
                assert!(is_sound(&run.roll, run.start_s, run.end_s));
                assert!(is_sound(&run.drive, run.start_s, run.end_s));
                assert!(!run.roll.time_s.is_empty());
                assert!(run.speed_m_s.is_none_or(f64::is_finite));
                assert!(run.excitation_rad_s.is_none_or(|w| w.is_finite() && w > 0.0));
                let still = run.still.map(|s| [s.start_s, s.end_s, s.roll_rad]);
                assert!(still.is_none_or(|s| s.iter().all(|v| v.is_finite())));
            }
            Event::Aftermath(after) => {
                let from_s = after.run_end_s.unwrap_or(f64::NEG_INFINITY);
                assert!(is_sound(&after.roll, from_s, f64::INFINITY));
                assert!(is_sound(&after.drive, from_s, f64::INFINITY));
                assert!(!after.roll.time_s.is_empty());
            }
            Event::Rejected(r) => {
                assert!(r.start_s <= r.end_s && r.end_s.is_finite(), "{r:?}");
                assert!(!r.reason.contains("NaN") && !r.reason.contains("inf"), "{r:?}");
            }
        }
    }
}

/// Any 64 bits as a number, NaN and the infinities included.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        -0.5..0.5_f64,
        Just(0.0),
        Just(f64::MAX),
        Just(f64::MIN_POSITIVE),
    ]
}

fn any_samples() -> impl Strategy<Value = Vec<Sample>> {
    let quantity = prop::sample::select(Quantity::ALL.to_vec());
    let sample = (quantity, any_number(), any_number())
        .prop_map(|(quantity, time_s, value)| Sample { quantity, time_s, value });
    prop::collection::vec(sample, 0..400)
}

/// A piece of roll: length [s], first amplitude [rad], decay rate [1/s], frequency [rad/s], mean
/// [rad], force amplitude [N], speed [m/s], and the sample interval [s].
type Piece = (f64, f64, f64, f64, f64, f64, f64, f64);

fn any_piece() -> impl Strategy<Value = Piece> {
    (
        0.1..25.0_f64,
        prop_oneof![Just(0.0), 0.0..0.4_f64],
        prop_oneof![Just(0.0), -0.3..2.0_f64],
        0.6..13.0_f64,
        -0.05..0.05_f64,
        prop_oneof![Just(0.0), 0.0..5.0_f64],
        prop_oneof![Just(0.0), -0.5..6.0_f64],
        prop::sample::select(vec![0.05, 0.02, 0.01, 0.7]),
    )
}

/// Pieces one after the other, now and then with a hole or a step back in time between them.
fn stream(pieces: &[Piece], jumps_s: &[f64]) -> Vec<Sample> {
    let mut samples = Vec::new();
    let mut start_s = 0.0;
    for (piece, jump_s) in pieces.iter().zip(jumps_s.iter().cycle()) {
        let (length_s, amplitude, rate, w, mean, force, speed, interval_s) = *piece;
        for k in 0..(length_s / interval_s) as usize {
            let t = k as f64 * interval_s;
            let time_s = start_s + t;
            // Three incommensurate sines stand for noise.
            let ripple = 3e-4 * ((310.0 * t).sin() + (173.0 * t).sin() + (97.0 * t).sin());
            let roll = mean + (amplitude * (-rate * t).exp()).min(0.8) * (w * t).cos() + ripple;
            let values = [roll, force * (w * t).sin() + 100.0 * ripple, speed + ripple];
            let quantities = [Quantity::Roll, Quantity::Force, Quantity::Speed];
            for (quantity, value) in quantities.into_iter().zip(values) {
                samples.push(Sample { quantity, time_s, value });
            }
        }
        start_s += length_s + jump_s;
    }
    samples
}

fn any_stream() -> impl Strategy<Value = Vec<Sample>> {
    let pieces = prop::collection::vec(any_piece(), 1..6);
    let jumps_s = prop::collection::vec(prop_oneof![Just(0.0), -2.0..5.0_f64], 1..4);
    (pieces, jumps_s).prop_map(|(pieces, jumps_s)| stream(&pieces, &jumps_s))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn any_numbers_are_answered(samples in any_samples()) {
        assert_sound(&events_in_chunks(&samples, &[7]));
    }

    #[test]
    fn any_motion_gives_the_same_events_however_it_is_cut(
        samples in any_stream(),
        lengths in prop::collection::vec(1..500_usize, 1..5),
        share in 0.0..1.0_f64,
    ) {
        let whole = events_in_chunks(&samples, &[samples.len()]);
        assert_sound(&whole);
        prop_assert_eq!(&whole, &events_in_chunks(&samples, &lengths));
        // What is known after a part of the stream stays as it was.
        let part = &samples[..(share * samples.len() as f64) as usize];
        let early = events_of(part);
        prop_assert_eq!(&early[..], &whole[..early.len()]);
    }
}
