//! What a program that died left behind becomes recordings at the next start, whatever its state.

use std::fs;
use std::path::Path;

use devices::Quantity::{Force, Moment, Roll, Speed};
use proptest::prelude::*;
use replay::{
    Exit, ExitStatus, Fate, Gap, LocalDisk, Loss, LossKind, Orphan, Provenance, Record, Recorded,
    Recorder, ReplayError, Severity, recover,
};

use crate::recorded_days::{
    RATE_HZ, RUN_INSTANTS, instants_kept, live, names, read, records, result, run_start, sample,
    time_s,
};
use crate::recordings::{folder, play_whole, write};
use replay::Columns;

/// A recorder in the middle of a recording of so many instants.
fn recorder(target: &Path, instants: u64) -> Recorder {
    let provenance =
        Provenance { campaign_text: "name = \"day\"".to_owned(), ..Provenance::default() };
    let mut recorder = Recorder::start(target, &provenance, live(), Box::new(LocalDisk))
        .expect("the recorder starts");
    for record in (0..instants).flat_map(records) {
        recorder.push(record).expect("it is recorded");
    }
    recorder
}

/// The part file that a recorder leaves which dies after so many instants.
fn part(instants: u64) -> Vec<u8> {
    let folder = folder();
    drop(recorder(&folder.path().join("pass.mcap"), instants));
    fs::read(folder.path().join("pass.mcap.part")).expect("it was left")
}

#[track_caller]
fn recovered(folder: &Path) -> Vec<Orphan> {
    recover(folder, &mut LocalDisk).expect("the folder can be read")
}

#[test]
fn an_orphan_is_finished_with_its_open_run_and_listed_with_its_counts() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let mut recorder = recorder(&target, 2000);
    let loss = |time_s, kind, count| {
        let (device, channel) = ("daq".to_owned(), "roll".to_owned());
        Record::Loss(Loss { time_s, device, channel, kind, count })
    };
    // The last run, 6, begins at 1.8 s; what was lost before it is none of its own.
    recorder.push(loss(1.7, LossKind::Lost, 50)).expect("it is recorded");
    recorder.push(loss(1.9, LossKind::Lost, 3)).expect("it is recorded");
    recorder.push(loss(1.9, LossKind::OverRange, 2)).expect("it is recorded");
    let gap = Gap {
        time_s: 2.0,
        device: "daq".to_owned(),
        channel: "force".to_owned(),
        start_s: 1.95,
        end_s: 2.0,
        lost: Some(49),
        reason: "link lost".to_owned(),
    };
    recorder.push(Record::Gap(gap.clone())).expect("it is recorded");
    drop(recorder);

    let orphans = recovered(folder.path());
    let [Orphan { part, fate: Fate::Recovered(finished) }] = &orphans[..] else {
        panic!("{orphans:?}")
    };
    assert_eq!(*part, folder.path().join("pass.mcap.part"));
    assert_eq!(finished.path, target);
    assert_eq!(finished.exit.status, ExitStatus::Recovered);
    let counts: Vec<_> = finished.samples.iter().map(|(quantity, _)| *quantity).collect();
    assert_eq!(counts, [Roll, Force, Moment, Speed]);
    assert!(finished.samples.iter().all(|(_, samples)| *samples == 2000), "{finished:?}");
    let runs: Vec<String> = (0..7).map(|run| format!("run {run}")).collect();
    assert_eq!(finished.runs_stopped, runs, "those of this story are never ended");
    assert_eq!((finished.torn_bytes, finished.spoilt_bytes, finished.unreadable), (0, 0, 0));

    let metadata = Recorded::open(&target).expect("it opens").metadata().clone();
    assert_eq!(metadata["exit_status"], "recovered");
    assert_eq!(metadata["reason"], "the program that recorded it died");
    assert_eq!(metadata["campaign"], "name = \"day\"");
    let records = read(&target);
    assert_eq!(instants_kept(&records), 2000);
    assert!(records.contains(&Record::Gap(gap)));
    let stop = records.iter().find_map(|record| match record {
        Record::RunStop(stop) if stop.run == "run 6" => Some(stop),
        _ => None,
    });
    let stop = stop.expect("it was ended");
    assert_eq!(stop.exit_status, ExitStatus::Recovered);
    assert_eq!(stop.reason, "the recording ended: the program that recorded it died");
    assert_eq!((stop.start_s, stop.end_s), (1.8, 2.0));
    let counts = |channel: &str| {
        let counts = stop.counts.iter().find(|counts| counts.channel == channel);
        let counts = counts.expect("it is counted");
        (counts.samples, counts.lost, counts.over_range)
    };
    assert_eq!((counts("roll"), counts("force")), ((200, 3, 2), (200, 49, 0)));

    let played = play_whole(&target, &Columns::default());
    assert_eq!(played.of(Roll).len(), 2000, "and it plays like any other");
    let note = played.note(Severity::Lost, "was recovered");
    assert!(
        note.ends_with("pass.mcap\" was recovered: the program that recorded it died"),
        "{note}"
    );
    assert_eq!(names(folder.path()), ["pass.mcap"]);
    assert!(recovered(folder.path()).is_empty(), "the next start finds nothing to do");
}

#[test]
fn a_recording_under_way_is_left_alone() {
    let folder = folder();
    let recorder = recorder(&folder.path().join("pass.mcap"), 100);
    let orphans = recovered(folder.path());
    let [Orphan { fate: Fate::Left(error), .. }] = &orphans[..] else { panic!("{orphans:?}") };
    assert!(matches!(error, ReplayError::InUse { .. }), "{error}");
    drop(recorder);
    assert!(matches!(recovered(folder.path())[0].fate, Fate::Recovered(_)));
}

#[test]
fn a_part_without_a_record_is_removed_and_anything_foreign_is_left() {
    let folder = folder();
    let mut whole = part(0);
    write(&folder, "none.mcap.part", &whole);
    whole.truncate(20);
    write(&folder, "torn.mcap.part", &whole);
    write(&folder, "touched.mcap.part", "");
    write(&folder, "foreign.mcap.part", "a letter");
    let options = mcap::WriteOptions::new().use_chunks(false);
    let mut other = std::io::Cursor::new(Vec::new());
    options.create(&mut other).and_then(|mut writer| writer.finish()).expect("it is written");
    write(&folder, "other.mcap.part", other.into_inner());
    let fates = recovered(folder.path()).into_iter().map(|orphan| match orphan.fate {
        Fate::Empty => "empty".to_owned(),
        Fate::Left(error) => error.to_string().rsplit('"').next().unwrap_or_default().to_owned(),
        fate => format!("{fate:?}"),
    });
    let foreign = " is not an MCAP file: it does not begin with the MCAP magic bytes";
    let other = " is no part of a recording of ours";
    assert_eq!(fates.collect::<Vec<_>>(), [foreign, "empty", other, "empty", "empty"]);
    assert_eq!(names(folder.path()), ["foreign.mcap.part", "other.mcap.part"]);
}

#[test]
fn a_recorder_that_died_while_finishing_is_finished_once() {
    let folder = folder();
    let bytes = part(500);
    write(&folder, "pass.mcap.part", &bytes);
    write(&folder, "pass.mcap.new", "half of a file");
    assert!(matches!(recovered(folder.path())[0].fate, Fate::Recovered(_)));
    let finished = fs::read(folder.path().join("pass.mcap")).expect("it is there");
    assert_eq!(names(folder.path()), ["pass.mcap"]);

    // It died after the new file had its name and before the part was gone.
    write(&folder, "pass.mcap.part", &bytes);
    let orphans = recovered(folder.path());
    assert!(matches!(&orphans[0].fate, Fate::AlreadyFinished { .. }), "{orphans:?}");
    assert_eq!(names(folder.path()), ["pass.mcap"]);
    assert_eq!(fs::read(folder.path().join("pass.mcap")).expect("it is there"), finished);

    // Another recording of the same name is another matter.
    write(&folder, "pass.mcap.part", part(400));
    let orphans = recovered(folder.path());
    let Fate::Recovered(other) = &orphans[0].fate else { panic!("{orphans:?}") };
    assert_eq!(other.path, folder.path().join("pass-2.mcap"));
    assert_eq!(fs::read(folder.path().join("pass.mcap")).expect("it is there"), finished);
}

#[test]
fn a_name_taken_while_it_was_recorded_is_not_overwritten() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let recorder = recorder(&target, 100);
    write(&folder, "pass.mcap", "precious");
    let error = recorder.finish(Exit::success("the pass is over")).expect_err("it is taken");
    assert!(matches!(error, ReplayError::Exists { .. }), "{error:?}");
    assert_eq!(names(folder.path()), ["pass.mcap", "pass.mcap.part"]);
    let orphans = recovered(folder.path());
    let Fate::Recovered(finished) = &orphans[0].fate else { panic!("{orphans:?}") };
    assert_eq!(finished.exit, Exit::success("the pass is over"), "it had come to its end");
    assert_eq!(instants_kept(&read(&folder.path().join("pass-2.mcap"))), 100);
    assert_eq!(fs::read(&target).expect("it is there"), b"precious");
}

#[test]
fn what_a_disk_spoilt_is_left_out_and_all_the_rest_is_kept() {
    let mut bytes = part(2000);
    // A page that never reached the disk, in the middle of the samples.
    let middle = bytes.len() / 2;
    bytes[middle..middle + 4096].fill(0);
    let folder = folder();
    write(&folder, "pass.mcap.part", &bytes);
    let orphans = recovered(folder.path());
    let Fate::Recovered(finished) = &orphans[0].fate else { panic!("{orphans:?}") };
    assert!(finished.spoilt_bytes >= 4096, "{finished:?}");
    assert_eq!((finished.torn_bytes, finished.unreadable), (0, 0));
    for (_, samples) in &finished.samples {
        let lost_s = (2000 - samples) as f64 / RATE_HZ as f64;
        assert!(lost_s > 0.0 && lost_s <= 0.2, "{lost_s} s around one page: {finished:?}");
    }
    assert!(is_true(&read(&finished.path)), "and what is kept is what was recorded");
    let played = play_whole(&finished.path, &Columns::default());
    let spoilt = format!("{} bytes of it were spoilt by the disk", finished.spoilt_bytes);
    played.note(Severity::Lost, &spoilt);
}

/// Whether every record is one that was recorded, or the end of a run that was.
fn is_true(found: &[Record]) -> bool {
    found.iter().all(|record| match record {
        Record::Sample(found) => {
            *found == sample(found.quantity, (found.time_s * RATE_HZ as f64).round() as u64)
        }
        Record::RunStart(start) => (0..9).any(|run| *start == run_start(run)),
        Record::Result(found) => (0..9).any(|run| *found == result(run)),
        Record::RunStop(stop) => stop.exit_status == ExitStatus::Recovered,
        record => records((record.time_s() * RATE_HZ as f64).round() as u64).contains(record),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn no_damage_makes_a_false_sample_and_a_tear_costs_only_what_is_behind_it(
        cut in 0.0..1.0_f64,
        spoilt in prop::collection::vec((0.0..1.0_f64, any::<u8>(), 1..5000_usize), 0..4),
    ) {
        let whole = part(RUN_INSTANTS * 2);
        let mut bytes = whole.clone();
        bytes.truncate((whole.len() as f64 * (1.0 - cut * cut)) as usize);
        for (at, value, length) in &spoilt {
            let start = (at * bytes.len() as f64) as usize;
            let end = (start + length).min(bytes.len());
            bytes[start..end].fill(*value);
        }
        let folder = folder();
        write(&folder, "pass.mcap.part", &bytes);
        let orphans = recovered(folder.path());
        if let Fate::Recovered(finished) = &orphans[0].fate {
            let found = read(&finished.path);
            prop_assert!(is_true(&found));
            if spoilt.is_empty() {
                let written = time_s(RUN_INSTANTS * 2) * bytes.len() as f64 / whole.len() as f64;
                let kept_s = time_s(instants_kept(&found));
                prop_assert!(kept_s + 0.2 > written, "{kept_s} s of {written} s");
            }
        }
        if spoilt.is_empty() && cut < 0.5 {
            prop_assert!(matches!(orphans[0].fate, Fate::Recovered(_)), "{:?}", orphans);
        }
    }
}
