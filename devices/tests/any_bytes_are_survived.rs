//! No bytes make a driver panic, grow, or miss what comes after them.

use devices::Quality;
use devices::driver::Decoded;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::wire::{FORMS, Wire, session};

/// Turns that let any driver finish its opening and come to readings.
const SETTLED_TURNS: usize = 40;
/// More than any session may hold: twice its longest frame.
const HELD_BYTES_MAX: usize = 1024;

/// Flips, drops, doubles, cuts and inserts bytes, as lines do.
fn mutate(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    for _ in 0..random.random_range(1..4) {
        let at = random.random_range(0..=bytes.len());
        match random.random_range(0..6) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.random_range(0..8),
            1 if at < bytes.len() => drop(bytes.remove(at)),
            2 => bytes.insert(at, random.random()),
            3 => bytes.truncate(at),
            4 => bytes.extend_from_within(..at),
            _ => {
                let noise: Vec<u8> =
                    (0..random.random_range(1..40)).map(|_| random.random()).collect();
                bytes.splice(at..at, noise);
            }
        }
    }
}

/// Spoils so many turns of each form; after each spoilt turn the next good readings must come.
fn spoil(n_turns: u64, seed: u64) -> (u64, u64) {
    let random = &mut ChaCha8Rng::seed_from_u64(seed);
    let (mut n_frames, mut n_spoilt) = (0, 0);
    for (name, settings) in FORMS {
        let mut wire = Wire::new(name, settings, Box::new(|field, _| 100.0 + field as f64));
        for _ in 0..SETTLED_TURNS {
            wire.turn(|_| {});
        }
        assert!(!wire.take_readings().is_empty(), "{name} {settings}");
        for turn in 0..n_turns {
            wire.turn(|bytes| {
                if !bytes.is_empty() {
                    mutate(bytes, random);
                    n_spoilt += 1;
                }
            });
            assert!(wire.session.n_held() <= HELD_BYTES_MAX, "{name} holds too much");
            wire.decoded.clear();
            // In a stream one frame may be lost to the noise before it. Who asks waits a silence
            // out, and then reads the first whole answer.
            let mut n_answered = 0;
            for _ in 0..8 {
                wire.turn(|_| {});
                n_answered += u32::from(wire.is_answered);
                let is_read =
                    wire.decoded.iter().any(|what| matches!(what, Decoded::Values { .. }));
                let is_first = wire.is_answered && n_answered == 1;
                assert!(is_read || !is_first, "{name} {settings}: missed after turn {turn}");
            }
            assert!(n_answered > 0 || !wire.session.asks(), "{name} {settings}: never answered");
            n_frames += 8;
            let readings = wire.take_readings();
            assert!(!readings.is_empty(), "{name} {settings}: deaf after turn {turn}");
            let last = readings.last().expect("it is not empty");
            let expected = 100.0 + last.field as f64;
            assert!((last.raw - expected).abs() < 1e-3, "{name} {settings}: {last:?}");
        }
    }
    (n_frames, n_spoilt)
}

#[test]
fn good_readings_follow_a_spoilt_answer_at_once() {
    spoil(300, 5);
}

/// `cargo test --release -p devices --test stories -- --ignored --nocapture ten_million`.
#[test]
#[ignore = "takes minutes; the property is tested on fewer frames above"]
fn ten_million_frames_are_survived() {
    let (mut n_frames, mut n_spoilt) = (0, 0);
    let mut seed = 100;
    while n_frames + n_spoilt < 10_000_000 {
        let (frames, spoilt) = spoil(2000, seed);
        (n_frames, n_spoilt, seed) = (n_frames + frames, n_spoilt + spoilt, seed + 1);
    }
    println!("{n_frames} good frames, {n_spoilt} spoilt ones, no panic, none deaf");
}

#[test]
fn a_stream_gives_every_frame_after_the_first_that_follows_noise() {
    let random = &mut ChaCha8Rng::seed_from_u64(11);
    let streams = FORMS.iter().filter(|(name, settings)| {
        let mut wire = Wire::new(name, settings, Box::new(|_, _| 0.0));
        (0..SETTLED_TURNS).for_each(|_| wire.turn(|_| {}));
        wire.session.wake_ns().is_none()
    });
    let mut n_streams = 0;
    for (name, settings) in streams {
        n_streams += 1;
        for _ in 0..200 {
            let mut wire =
                Wire::new(name, settings, Box::new(|_, time_s| (5000.0 * time_s).floor()));
            for _ in 0..SETTLED_TURNS {
                wire.turn(|_| {});
            }
            // Only whole frames from here on: noise stands between two of them.
            wire.take_readings();
            let noise: Vec<u8> = (0..random.random_range(1..60)).map(|_| random.random()).collect();
            wire.turn(|bytes| drop(bytes.splice(0..0, noise)));
            let mut n_clean = 0;
            for _ in 0..30 {
                wire.turn(|bytes| n_clean += usize::from(!bytes.is_empty()));
            }
            let readings = wire.take_readings();
            // A frame after noise waits for the witness behind it.
            let per_frame = if *name == "cobs" { 3 } else { 1 };
            let n_read = readings.len() / per_frame;
            assert!(n_read + 1 >= n_clean, "{name}: {n_read} of {n_clean}");
            let rising = readings.windows(2).filter(|two| two[0].field == two[1].field);
            for two in rising {
                assert!(two[1].raw >= two[0].raw, "{name} {settings}: {two:?}");
            }
        }
    }
    assert_eq!(n_streams, 8);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_in_any_pieces_are_survived_by_every_driver(
        bytes in prop::collection::vec(any::<u8>(), 0..3000),
        cuts in prop::collection::vec(1_usize..700, 1..20),
        steps_ns in prop::collection::vec(0_u64..300_000_000, 1..20),
    ) {
        for (name, settings) in FORMS {
            let mut session = session(name, settings);
            session.open(0);
            let (mut decoded, mut sent) = (Vec::new(), Vec::new());
            let (mut rest, mut now_ns) = (&bytes[..], 0);
            for (cut, step_ns) in cuts.iter().cycle().zip(steps_ns.iter().cycle()) {
                if rest.is_empty() {
                    break;
                }
                let (piece, after) = rest.split_at((*cut).min(rest.len()));
                now_ns += step_ns;
                session.poll(now_ns, &mut sent, &mut decoded);
                session.receive(piece, now_ns, &mut decoded);
                prop_assert!(session.n_held() <= HELD_BYTES_MAX);
                rest = after;
            }
            // Each byte is told of at most once, each turn at most two silences and a remainder.
            let told: usize = decoded.iter().map(|what| match what {
                Decoded::Damaged { n_bytes, .. } => *n_bytes,
                _ => 0,
            }).sum();
            prop_assert!(told <= bytes.len(), "{name}: {told} of {}", bytes.len());
        }
    }

    #[test]
    fn what_an_instrument_says_is_what_is_read(raws in prop::collection::vec(-8200_i32..8200, 3)) {
        for (name, settings) in FORMS {
            let said = raws.clone();
            // A module in engineering form shows five digits.
            let signal = move |field: usize, _: f64| f64::from(said[field % 3]) / 8.0;
            let mut wire = Wire::new(name, settings, Box::new(signal));
            for _ in 0..SETTLED_TURNS {
                wire.turn(|_| {});
            }
            let whole = name.starts_with("hbm") || name == "cobs" || settings.contains("int16")
                || settings.contains("hexadecimal");
            let readings = wire.take_readings();
            prop_assert!(!readings.is_empty(), "{name} {settings}");
            for reading in readings {
                let expected = f64::from(raws[reading.field % 3]) / 8.0;
                // So that a thousand is beyond its range, which it says in place of a value.
                if name == "dcon" && !whole && expected.abs() >= 999.995 {
                    prop_assert_eq!(reading.quality, Quality::OVER_RANGE, "{}", settings);
                    continue;
                }
                let tolerance = if whole { 0.5 } else { 0.051 };
                prop_assert!((reading.raw - expected).abs() <= tolerance, "{name}: {reading:?}");
            }
        }
    }
}
