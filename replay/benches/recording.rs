//! How fast samples are recorded, how large they are, how long finishing takes.
#![expect(clippy::print_stdout, reason = "sizes are figures too")]
#![allow(missing_docs, reason = "a benchmark has no reader but its output")]

use std::path::Path;
use std::time::Duration;

use devices::{Quantity, Sample};
use divan::Bencher;
use divan::counter::ItemsCount;
use replay::{ClosedRecording, Exit, LocalDisk, Provenance, Recorder, Settings, recover};

const RATE_HZ: u64 = 1000;
const TEN_MINUTES: u64 = 600 * RATE_HZ;
const CHANNELS: u64 = Quantity::ALL.len() as u64;

fn main() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let finished = record(folder.path(), TEN_MINUTES).convert().expect("the disk has room");
    let samples = (CHANNELS * TEN_MINUTES) as f64;
    println!(
        "10 minutes of 4 channels at 1 kHz, noise of the last digits of a 16-bit converter: \
         part {:.1} MB, {:.1} bytes a sample; finished {:.1} MB, {:.1} bytes a sample\n",
        finished.part_bytes as f64 / 1e6,
        finished.part_bytes as f64 / samples,
        finished.file_bytes as f64 / 1e6,
        finished.file_bytes as f64 / samples,
    );
    divan::main();
}

/// What a 16-bit converter makes of a rolling model, with noise in its last bits.
fn sample(quantity: Quantity, instant: u64) -> Sample {
    let time_s = instant as f64 / RATE_HZ as f64;
    let noise = (instant.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 61) as f64;
    let counts = (12_000.0 * (2.4 * time_s + f64::from(quantity as u8)).sin() + noise).round();
    Sample { quantity, time_s, value: counts * 0.35 / 32_768.0 }
}

fn start(folder: &Path) -> Recorder {
    let settings = Settings { reserve_bytes: 0, ..Settings::LIVE };
    let target = folder.join("pass.mcap");
    Recorder::start(&target, &Provenance::default(), settings, Box::new(LocalDisk))
        .expect("the recorder starts")
}

fn record(folder: &Path, instants: u64) -> ClosedRecording {
    let mut recorder = start(folder);
    push(&mut recorder, instants);
    recorder.close(Exit::success("bench")).expect("the disk has room")
}

/// Pushes as the writer's loop does, a tick for each instant.
fn push(recorder: &mut Recorder, instants: u64) {
    for instant in 0..instants {
        for quantity in Quantity::ALL {
            recorder.push(sample(quantity, instant)).expect("the disk has room");
        }
        recorder.tick(Duration::from_millis(instant)).expect("the disk has room");
    }
}

/// Samples recorded, as many a second as the machine takes.
#[divan::bench(sample_count = 20)]
fn samples_are_recorded(bencher: Bencher) {
    const INSTANTS: u64 = 20 * RATE_HZ;
    bencher
        .counter(ItemsCount::new(CHANNELS * INSTANTS))
        .with_inputs(|| {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            (start(folder.path()), folder)
        })
        .bench_local_values(|(mut recorder, folder)| {
            push(&mut recorder, INSTANTS);
            (recorder, folder)
        });
}

/// Ten minutes from the part file to the finished one with its name, read back.
#[divan::bench(sample_count = 5)]
fn ten_minutes_are_finished(bencher: Bencher) {
    bencher
        .counter(ItemsCount::new(CHANNELS * TEN_MINUTES))
        .with_inputs(|| {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            (record(folder.path(), TEN_MINUTES), folder)
        })
        .bench_local_values(|(closed, folder)| {
            let finished = closed.convert().expect("the disk has room");
            (finished, folder)
        });
}

/// The same, found at the start of the next program.
#[divan::bench(sample_count = 5)]
fn ten_minutes_are_recovered(bencher: Bencher) {
    bencher
        .counter(ItemsCount::new(CHANNELS * TEN_MINUTES))
        .with_inputs(|| {
            let folder = tempfile::tempdir().expect("a temporary folder can be made");
            drop(record(folder.path(), TEN_MINUTES));
            folder
        })
        .bench_local_values(|folder| {
            let orphans = recover(folder.path(), &mut LocalDisk).expect("it can be read");
            (orphans, folder)
        });
}
