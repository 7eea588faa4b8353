//! Every kind of record, and the seconds before a trigger, come back as they were recorded.

use std::path::Path;
use std::time::Duration;

use devices::Quantity::{Force, Roll};
use replay::{
    AttachedDevice, Calibration, CampaignFile, ChannelCounts, ClockReading, Columns, Direction,
    Exit, ExitStatus, Gap, LocalDisk, Loss, LossKind, PreTrigger, Provenance, QualityChange, Raw,
    Record, Recorded, Recorder, Rejection, ReplayError, RunStop,
};

use crate::recorded_days::{live, raw, read, records, result, run_start, sample, time_s};
use crate::recordings::{folder, play_whole};

fn start(target: &Path) -> Recorder {
    let provenance = Provenance { zero_log_time_ns: 1_790_000_000_000_000_001, ..provenance() };
    Recorder::start(target, &provenance, live(), Box::new(LocalDisk)).expect("it starts")
}

fn provenance() -> Provenance {
    Provenance {
        campaign_text: "name = \"OE basin\"".to_owned(),
        source: "daq".to_owned(),
        zero_log_time_ns: 0,
    }
}

fn device() -> Record {
    Record::Device(AttachedDevice {
        time_s: 0.0,
        device: "daq".to_owned(),
        profile: "generic_line".to_owned(),
        port: "/dev/serial/by-id/usb-FTDI_A1".to_owned(),
        settings: "baud = 115200\npattern = '^\\$RD,(\\d+)'\n".to_owned(),
    })
}

fn calibration(time_s: f64, gain: f64) -> Record {
    Record::Calibration(Calibration {
        time_s,
        device: "daq".to_owned(),
        channel: "roll".to_owned(),
        by: "K. Tanaka".to_owned(),
        taken: "2026-11-26T08:40:00+09:00".to_owned(),
        definition: format!("zero = -0.25\ngain = {gain}\n"),
    })
}

/// One record of every kind, as awkward as each may be.
pub(crate) fn every_kind() -> Vec<Record> {
    let (daq, roll) = ("daq".to_owned(), "roll".to_owned());
    let bytes = (0..=255).cycle().take(1000).collect();
    let sent = Raw { device: "a \"b\"/ü".into(), time_s: 0.25, direction: Direction::Sent, bytes };
    let counts = ChannelCounts {
        channel: roll.clone(),
        samples: 1000,
        lost: 1,
        repeated: 2,
        over_range: 3,
        damaged: 4,
        clock_bound_s: Some(2.5e-4),
    };
    vec![
        device(),
        calibration(0.0, 0.125),
        Record::Campaign(CampaignFile { time_s: 0.0, text: "name = \"α\"\n\u{0}".to_owned() }),
        Record::Clock(ClockReading {
            time_s: 0.0,
            monotonic_ns: u64::MAX,
            realtime_ns: 1_790_000_000_000_000_001,
            tai_offset_s: 37,
        }),
        Record::RunStart(run_start(0)),
        Record::Raw(raw(10)),
        Record::Raw(sent),
        sample(Roll, 10).into(),
        sample(Force, 10).into(),
        Record::Gap(Gap {
            time_s: 0.5,
            device: daq.clone(),
            channel: String::new(),
            start_s: 0.1,
            end_s: 0.5,
            lost: None,
            reason: "link lost".to_owned(),
        }),
        Record::Loss(Loss {
            time_s: 0.5,
            device: daq.clone(),
            channel: roll.clone(),
            kind: LossKind::Repeated,
            count: 7,
        }),
        Record::Quality(QualityChange {
            time_s: 0.5,
            device: daq,
            channel: roll,
            flags: "over range, lagged".to_owned(),
        }),
        Record::RunStop(RunStop {
            time_s: 0.6,
            run: "run 0".to_owned(),
            start_s: 0.0,
            end_s: 0.59,
            exit_status: ExitStatus::Success,
            reason: "the roll died away".to_owned(),
            counts: vec![counts],
        }),
        Record::Result(result(0)),
        Record::Rejection(Rejection {
            time_s: 0.7,
            start_s: 0.6,
            end_s: 0.7,
            reason: "three swings, at least four are needed".to_owned(),
        }),
    ]
}

#[test]
fn every_kind_of_record_comes_back_as_it_was() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let mut recorder = start(&target);
    for record in every_kind() {
        recorder.push(record).expect("it is recorded");
    }
    assert_eq!(recorder.progress().records, every_kind().len() as u64);
    let part = folder.path().join("pass.mcap.part");
    assert_eq!(read(&part), every_kind(), "documents are in the file at once");
    let finished = recorder.finish(Exit::success("the day is over")).expect("it is finished");
    assert_eq!(read(&target), every_kind());
    assert_eq!(finished.samples, [(Roll, 1), (Force, 1)]);
    assert_eq!(finished.topics["/raw/daq"], 1);
    assert!(finished.runs_stopped.is_empty(), "the run was ended");
    let metadata = Recorded::open(&target).expect("it opens").metadata().clone();
    assert_eq!(metadata["reason"], "the day is over");
    assert_eq!(metadata["source"], "daq");
    let played = play_whole(&target, &Columns::default());
    assert_eq!(played.samples, [sample(Roll, 10), sample(Force, 10)]);
}

#[test]
fn a_document_with_a_number_that_json_cannot_hold_is_refused() {
    let folder = folder();
    let mut recorder = start(&folder.path().join("pass.mcap"));
    let reason = String::new();
    let rejection = Rejection { time_s: 1.0, start_s: f64::NAN, end_s: 1.0, reason };
    let error = recorder.push(Record::Rejection(rejection)).expect_err("it is refused");
    assert!(matches!(error, ReplayError::UnrecordableDocument { .. }), "{error:?}");
    assert!(error.to_string().ends_with("value and time must be finite"), "{error}");
}

#[test]
fn records_reach_the_system_within_the_time_that_was_set() {
    let folder = folder();
    let (target, part) = (folder.path().join("pass.mcap"), folder.path().join("pass.mcap.part"));
    let mut recorder = start(&target);
    recorder.push(sample(Roll, 0)).expect("it is recorded");
    recorder.tick(Duration::from_millis(10)).expect("nothing is due");
    assert_eq!(read(&part), [], "it waits for company");
    recorder.tick(Duration::from_millis(60)).expect("the disk has room");
    assert_eq!(read(&part), [sample(Roll, 0).into()], "its time has come");
    // Where no tick comes through, the records' own times do.
    for instant in 1..1000 {
        recorder.push(sample(Roll, instant)).expect("it is recorded");
        let kept = read(&part).len() as u64;
        assert!(kept + 51 >= instant, "{kept} of {instant}");
    }
}

#[test]
fn a_recording_begins_before_its_trigger_and_goes_on_in_the_same_file() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let mut ring = PreTrigger::new(0.5, 1 << 20);
    ring.push(device());
    ring.push(calibration(0.0, 0.125));
    ring.push(calibration(0.1, 0.25));
    for record in (0..3000).flat_map(records) {
        ring.push(record);
    }
    assert_eq!(ring.crowded_out(), 0);
    let mut recorder = start(&target);
    ring.pour().for_each(|record| recorder.push(record).expect("it is recorded"));
    assert!(ring.is_empty());
    for record in (3000..4000).flat_map(records) {
        recorder.push(record).expect("it is recorded");
    }
    recorder.finish(Exit::success("the pass is over")).expect("it is finished");
    let from_s = time_s(2999) - 0.5;
    let expected = [device(), calibration(0.1, 0.25)]
        .into_iter()
        .chain((0..4000).flat_map(records).filter(|record| record.time_s() >= from_s));
    let mut found = read(&target);
    // The runs that this story never ends were ended with the recording.
    found.retain(|record| !matches!(record, Record::RunStop(_)));
    assert_eq!(found, expected.collect::<Vec<_>>(), "half a second before, and all after");

    let mut next = start(&folder.path().join("next.mcap"));
    ring.pour().for_each(|record| next.push(record).expect("it is recorded"));
    let part = folder.path().join("next.mcap.part");
    assert_eq!(read(&part), [device(), calibration(0.1, 0.25)], "what holds, holds on");
}

#[test]
fn a_ring_takes_no_more_memory_than_it_was_given() {
    let mut ring = PreTrigger::new(3600.0, 100_000);
    for record in (0..10_000).flat_map(records) {
        ring.push(record);
    }
    assert!(ring.len() < 2000, "{}", ring.len());
    assert!(ring.crowded_out() > 30_000, "{}", ring.crowded_out());
    let remembered = ring.len();
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let mut recorder = start(&target);
    ring.pour().for_each(|record| recorder.push(record).expect("it is recorded"));
    recorder.finish(Exit::success("it was full")).expect("it is finished");
    let mut found = read(&target);
    found.retain(|record| !matches!(record, Record::RunStop(_)));
    assert_eq!(found.len(), remembered);
    let latest: Vec<_> = (0..10_000).flat_map(records).collect();
    assert!(latest.ends_with(&found), "the latest of all, without a hole");
}
