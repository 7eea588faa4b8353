//! Samples that are skipped or repeated on command are, by every emulator in each of its forms.

use std::collections::BTreeMap;

use devices::Quality;
use devices::driver::{Decoded, FieldValue, Purpose};
use devices::emulator::{EMULATORS, Fault};

use crate::wire::{FORMS, Wire};

const N_FAULTS: u64 = 3;
/// Turns that let any driver finish its opening.
const SETTLED_TURNS: usize = 40;
const TURNS: usize = 60;

/// A conversation with an instrument of which no two conversions at a kilohertz are alike.
fn settled(name: &str, settings: &str) -> Wire {
    // A module in engineering form shows five digits.
    let per_s = if name == "dcon" && !settings.contains("hexadecimal") { 100.0 } else { 1000.0 };
    let signal = Box::new(move |_, time_s: f64| (time_s * 1000.0).round() * (per_s / 1000.0));
    let mut wire = Wire::at_rate(name, settings, 1000.0, signal);
    (0..SETTLED_TURNS).for_each(|_| wire.turn(|_| {}));
    wire
}

/// Frames of readings, and requests to read that brought none, after a fault was commanded.
fn after(name: &str, settings: &str, fault: Fault) -> (Vec<Vec<FieldValue>>, u64) {
    let mut wire = settled(name, settings);
    // What came before is kept, so that the first frame has one to be compared with.
    wire.decoded.retain(|what| matches!(what, Decoded::Values { .. }));
    wire.faults.command(fault);
    (0..TURNS).for_each(|_| wire.turn(|_| {}));
    let (mut frames, mut n_silent) = (Vec::new(), 0);
    for what in &wire.decoded {
        match what {
            Decoded::Values { values, .. } => frames.push(values.clone()),
            Decoded::Silent { purpose: Purpose::Read, .. } => n_silent += 1,
            _ => {}
        }
    }
    (frames, n_silent)
}

/// Steps of each field from one frame to the next [conversions].
fn steps(frames: &[Vec<FieldValue>], per_conversion: f64) -> Vec<u64> {
    let mut last: BTreeMap<usize, f64> = BTreeMap::new();
    let mut steps = Vec::new();
    for values in frames {
        let first = values[0];
        if let Some(before) = last.insert(first.field, first.raw) {
            steps.push(((first.raw - before) / per_conversion).round() as u64);
        }
    }
    steps
}

#[test]
fn the_forms_go_through_every_emulator() {
    let names: Vec<&str> = EMULATORS.iter().map(|emulator| emulator.driver).collect();
    assert!(names.iter().all(|name| FORMS.iter().any(|(form, _)| form == name)), "{names:?}");
}

#[test]
fn repeated_samples_come_again() {
    for (name, settings) in FORMS {
        let per_conversion =
            if name == "dcon" && !settings.contains("hexadecimal") { 0.1 } else { 1.0 };
        let (frames, n_silent) = after(name, settings, Fault::Repeat(N_FAULTS));
        let n_alike =
            steps(&frames, per_conversion).iter().filter(|step| **step == 0).count() as u64;
        assert_eq!((n_alike, n_silent), (N_FAULTS, 0), "{name} {settings}");
        // Who can tell that a reading is old does so.
        let says = |values: &&Vec<FieldValue>| values[0].quality.has(Quality::REPEATED);
        let n_said = frames.iter().filter(says).count() as u64;
        let can_say = settings.contains("status") || settings.contains("synchronised");
        assert_eq!(n_said, if can_say { N_FAULTS } else { 0 }, "{name} {settings}");
    }
}

#[test]
fn skipped_samples_do_not_come() {
    for (name, settings) in FORMS {
        let (frames, n_silent) = after(name, settings, Fault::Skip(N_FAULTS));
        if settled(name, settings).session.asks() {
            assert_eq!(n_silent, N_FAULTS, "{name} {settings}");
            continue;
        }
        let n_skipped: u64 = steps(&frames, 1.0).iter().map(|step| step.saturating_sub(1)).sum();
        assert_eq!((n_skipped, n_silent), (N_FAULTS, 0), "{name} {settings}");
    }
}
