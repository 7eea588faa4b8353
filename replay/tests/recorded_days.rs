//! Recordings whose every record follows from its number, so that a lost or damaged one is seen.

use std::fs;
use std::path::Path;

use devices::{Quantity, Sample};
use replay::{Direction, Raw, Record, Recorded, RunResult, RunStart, Settings};

/// Samples of each of the four channels in a second.
pub(crate) const RATE_HZ: u64 = 1000;
/// Instants from one run's beginning to the next.
pub(crate) const RUN_INSTANTS: u64 = 300;

/// Time of an instant [s].
pub(crate) fn time_s(instant: u64) -> f64 {
    instant as f64 / RATE_HZ as f64
}

/// The sample of a channel at an instant: a rolling model, and a number that no other sample has.
pub(crate) fn sample(quantity: Quantity, instant: u64) -> Sample {
    let time_s = time_s(instant);
    let value = (2.4 * time_s + f64::from(quantity as u8)).sin() + 1e-3 * instant as f64;
    Sample { quantity, time_s, value }
}

/// What the device sent that had these samples in it.
pub(crate) fn raw(instant: u64) -> Raw {
    let bytes = format!("$RD,{instant},").into_bytes();
    let bytes = bytes.into_iter().chain((0..=255).map(|byte: u8| byte ^ instant as u8)).collect();
    Raw { device: "daq".into(), time_s: time_s(instant), direction: Direction::Received, bytes }
}

/// Everything that comes at an instant, in its order.
pub(crate) fn records(instant: u64) -> Vec<Record> {
    let mut records: Vec<Record> =
        Quantity::ALL.iter().map(|quantity| sample(*quantity, instant).into()).collect();
    if instant.is_multiple_of(10) {
        records.push(Record::Raw(raw(instant)));
    }
    if instant % RUN_INSTANTS == RUN_INSTANTS / 2 {
        records.push(Record::RunStart(run_start(instant / RUN_INSTANTS)));
    }
    if instant % RUN_INSTANTS == RUN_INSTANTS - 1 {
        records.push(Record::Result(result(instant / RUN_INSTANTS)));
    }
    records
}

/// The beginning of a run; it is found only halfway.
pub(crate) fn run_start(run: u64) -> RunStart {
    RunStart {
        time_s: time_s(run * RUN_INSTANTS + RUN_INSTANTS / 2),
        run: format!("run {run}"),
        kind: "decay".to_owned(),
        condition: "bare hull".to_owned(),
        start_s: time_s(run * RUN_INSTANTS),
    }
}

/// What is identified from a run, at its last instant.
pub(crate) fn result(run: u64) -> RunResult {
    RunResult {
        time_s: time_s((run + 1) * RUN_INSTANTS - 1),
        run: format!("run {run}"),
        schema: "rolltank.identification/1".to_owned(),
        document: format!("{{\"b1_per_s\":{{\"mean\":{:?}}}}}", 0.1 + run as f64 / 7.0),
    }
}

/// Everything in a recording.
#[track_caller]
pub(crate) fn read(path: &Path) -> Vec<Record> {
    let mut recorded = Recorded::open(path).expect("the recording opens");
    let next = || recorded.next_record().expect("it is read to its end");
    std::iter::from_fn(next).collect()
}

/// Instants from the first on whose samples came back, each sample equal to the one it was.
#[track_caller]
pub(crate) fn instants_kept(records: &[Record]) -> u64 {
    let kept = Quantity::ALL.map(|quantity| {
        let of = records.iter().filter_map(|record| match record {
            Record::Sample(sample) if sample.quantity == quantity => Some(*sample),
            _ => None,
        });
        let mut kept = 0;
        for found in of {
            assert_eq!(found, sample(quantity, kept), "each sample in its place");
            kept += 1;
        }
        kept
    });
    let least = kept.into_iter().min().expect("there are four");
    assert!(kept.iter().all(|channel| channel - least <= 1), "{kept:?}");
    let raws = records.iter().filter_map(|record| match record {
        Record::Raw(raw) => Some(raw),
        _ => None,
    });
    for (number, found) in (0..).zip(raws) {
        assert_eq!(*found, raw(10 * number), "each reading in its place");
    }
    least
}

/// The files of a folder, sorted.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be read");
    let name = |entry: std::io::Result<fs::DirEntry>| {
        entry.expect("an entry").file_name().to_string_lossy().into_owned()
    };
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    names
}

/// The settings for instruments, with no room left to others: a test's disk is its own.
pub(crate) fn live() -> Settings {
    Settings { reserve_bytes: 0, ..Settings::LIVE }
}
