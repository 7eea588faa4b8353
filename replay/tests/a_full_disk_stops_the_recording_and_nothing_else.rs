//! A disk fills up or fails in the middle of a recording; what was recorded stays, and the caller
//! goes on.
//!
//! The real disk is a tmpfs of a few megabytes in a mount namespace of its own, which vanishes with
//! the process that fills it. Where no such namespace is allowed, a disk with a quota stands in.

use std::env;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use replay::{
    Disk, Exit, ExitStatus, Fate, LocalDisk, Orphan, Provenance, Record, Recorder, ReplayError,
    Settings, recover,
};

use crate::recorded_days::{RATE_HZ, instants_kept, live, names, read, records, time_s};
use crate::recordings::folder;
use crate::small_disk::{FOLDER, told_on_a_disk_of};

/// What the small disk holds [bytes], and what of it is taken by something else at first.
const DISK_BYTES: u64 = 6 << 20;
const BALLAST_BYTES: u64 = 3 << 20;
/// Instants that wait at most for the system when the disk is full.
const WAITING_INSTANTS_MAX: u64 = RATE_HZ / 20 + 1;

/// A disk that takes only so many bytes, or fails.
#[derive(Clone)]
struct Quota {
    left_bytes: Arc<AtomicU64>,
    told: ErrorKind,
}

impl Quota {
    fn new(left_bytes: u64, told: ErrorKind) -> Self {
        Self { left_bytes: Arc::new(AtomicU64::new(left_bytes)), told }
    }
}

impl Disk for Quota {
    fn free_bytes(&mut self, _: &Path) -> io::Result<u64> {
        Ok(self.left_bytes.load(Ordering::Relaxed))
    }

    fn append(&mut self, file: &mut File, bytes: &[u8]) -> io::Result<()> {
        let left = self.left_bytes.load(Ordering::Relaxed);
        // As a real disk does it: what fits is written, the rest is not.
        let fits = left.min(bytes.len() as u64);
        file.write_all(&bytes[..fits as usize])?;
        self.left_bytes.store(left - fits, Ordering::Relaxed);
        if fits < bytes.len() as u64 { Err(self.told.into()) } else { Ok(()) }
    }
}

/// Records until the disk stops it: the instants pushed by then, and the alarm.
fn record_until_stopped(recorder: &mut Recorder, page: &mut Vec<Record>) -> (u64, ReplayError) {
    for instant in 0..1_000_000 {
        let mut alarm = None;
        for record in records(instant) {
            page.push(record.clone());
            if let Err(error) = recorder.push(record) {
                assert!(alarm.is_none(), "the alarm is given once");
                alarm = Some(error);
            }
        }
        let ticked = recorder.tick(Duration::from_secs_f64(time_s(instant)));
        if let Some(error) = alarm.or(ticked.err()) {
            return (instant + 1, error);
        }
    }
    panic!("the disk never filled up");
}

/// The whole story on one disk; `make_room` takes the ballast away.
fn story(
    folder: &Path,
    disk: &mut (impl Disk + Clone + 'static),
    make_room: impl FnOnce(),
) -> String {
    let target = folder.join("pass.mcap");
    let boxed = Box::new(disk.clone());
    let mut recorder =
        Recorder::start(&target, &Provenance::default(), live(), boxed).expect("there is room yet");
    let mut page = Vec::new();
    let (pushed, alarm) = record_until_stopped(&mut recorder, &mut page);
    let ReplayError::DiskFull { written_bytes, .. } = &alarm else { panic!("{alarm:?}") };
    let part = folder.join("pass.mcap.part");
    let length = fs::metadata(&part).expect("it is there").len();
    assert_eq!(length, *written_bytes, "what did not fit is taken back");
    assert!(alarm.to_string().contains("the disk is full"), "{alarm}");
    assert!(alarm.hint().expect("there is a hint").contains("make room"));

    // The instruments go on and the page shows them.
    for instant in pushed..pushed + 10_000 {
        for record in records(instant) {
            page.push(record.clone());
            recorder.push(record).expect("it is let go");
        }
        recorder.tick(Duration::from_secs_f64(time_s(instant))).expect("it was told");
    }
    assert_eq!(instants_kept(&page), pushed + 10_000, "nothing is missing on the page");
    let progress = recorder.progress();
    assert!(progress.stopped);
    assert!(progress.unrecorded >= 40_000, "{progress:?}");

    let exit = Exit { status: ExitStatus::Abort, reason: "the disk is full".to_owned() };
    let error = recorder.finish(exit).expect_err("there is no room for the finished file");
    assert!(matches!(error, ReplayError::DiskFull { .. }), "{error:?}");
    assert!(names(folder).contains(&"pass.mcap.part".to_owned()), "{:?}", names(folder));
    assert!(!names(folder).contains(&"pass.mcap.new".to_owned()), "half a file is no use");

    make_room();
    let orphans = recover(folder, disk).expect("the folder can be read");
    let [orphan] = &orphans[..] else { panic!("{orphans:?}") };
    let Fate::Recovered(finished) = &orphan.fate else { panic!("{orphan:?}") };
    assert_eq!((finished.torn_bytes, finished.spoilt_bytes), (0, 0), "it was cut back cleanly");
    let kept = instants_kept(&read(&target));
    assert!(kept + WAITING_INSTANTS_MAX >= pushed, "{kept} of {pushed}");
    format!("full after {pushed} instants, {kept} kept, then 10000 more shown; recovered")
}

#[test]
#[ignore = "run by the story beside it, in a mount namespace of its own"]
fn child_that_fills_the_small_disk() {
    let folder = PathBuf::from(env::var_os(FOLDER).expect("the story names the folder"));
    let ballast = folder.join("ballast");
    fs::write(&ballast, vec![1; BALLAST_BYTES as usize]).expect("it fits");
    let remove = || fs::remove_file(&ballast).expect("it is there");
    println!("\n{}", story(&folder, &mut LocalDisk, remove));
}

#[test]
fn a_disk_that_fills_up_takes_nothing_that_was_recorded() {
    let child = concat!(module_path!(), "::child_that_fills_the_small_disk");
    if let Some(told) = told_on_a_disk_of(DISK_BYTES, child) {
        let told = told.lines().find(|line| line.starts_with("full after"));
        println!("tmpfs of {DISK_BYTES} bytes: {}", told.expect("the child tells"));
        return;
    }
    println!("no tmpfs may be mounted here, a disk with a quota stands in: {}", quota_story());
}

#[test]
fn a_quota_that_runs_out_takes_nothing_that_was_recorded() {
    println!("quota of {} bytes: {}", DISK_BYTES - BALLAST_BYTES, quota_story());
}

fn quota_story() -> String {
    let folder = folder();
    let mut disk = Quota::new(DISK_BYTES - BALLAST_BYTES, ErrorKind::StorageFull);
    let left = disk.left_bytes.clone();
    story(folder.path(), &mut disk, || left.store(BALLAST_BYTES, Ordering::Relaxed))
}

#[test]
fn little_room_stops_the_recording_while_it_can_still_be_finished() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let settings = Settings { reserve_bytes: 1 << 20, ..Settings::LIVE };
    let disk = Quota::new(5 << 20, ErrorKind::StorageFull);
    let mut recorder =
        Recorder::start(&target, &Provenance::default(), settings, Box::new(disk.clone()))
            .expect("there is room yet");
    let (pushed, alarm) = record_until_stopped(&mut recorder, &mut Vec::new());
    let ReplayError::NearlyFull { free_bytes, reserve_bytes, part_bytes, .. } = &alarm else {
        panic!("{alarm:?}")
    };
    assert!(*free_bytes < reserve_bytes + part_bytes, "{alarm}");
    recorder.push(records(pushed)[0].clone()).expect("it is let go");
    let exit = Exit { status: ExitStatus::Abort, reason: "the disk is nearly full".to_owned() };
    let finished = recorder.finish(exit).expect("there is room to finish");
    assert_eq!(instants_kept(&read(&target)), pushed, "all that was pushed before the alarm");
    assert_eq!(finished.unrecorded, 1);
    assert!(disk.left_bytes.load(Ordering::Relaxed) > *reserve_bytes, "the rest is left to others");

    let target = folder.path().join("next.mcap");
    let disk = Box::new(Quota::new(1000, ErrorKind::StorageFull));
    let started = Recorder::start(&target, &Provenance::default(), settings, disk);
    let error = started.err().expect("there is too little room to start");
    assert!(matches!(error, ReplayError::NearlyFull { .. }), "{error:?}");
    assert_eq!(names(folder.path()), ["pass.mcap"], "nothing is left behind");
}

#[test]
fn a_failing_disk_is_told_and_the_recording_before_it_kept() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let disk = Box::new(Quota::new(2 << 20, ErrorKind::Other));
    let mut recorder = Recorder::start(&target, &Provenance::default(), live(), disk)
        .expect("the disk works at first");
    let (pushed, alarm) = record_until_stopped(&mut recorder, &mut Vec::new());
    assert!(matches!(alarm, ReplayError::Write { .. }), "{alarm:?}");
    drop(recorder);
    let orphans = recover(folder.path(), &mut LocalDisk).expect("the folder can be read");
    let [Orphan { fate: Fate::Recovered(finished), .. }] = &orphans[..] else {
        panic!("{orphans:?}")
    };
    assert_eq!(finished.exit.status, ExitStatus::Recovered);
    assert!(instants_kept(&read(&target)) + WAITING_INSTANTS_MAX >= pushed);
}
