//! A recording of any length is read, and recorded, in the same small memory.
//!
//! Reader and recorder run as processes of their own, so that their peak memory is their own too.
//! The size of the table in megabytes is `ROLLTANK_BIG_CSV_MB`, the length of the recording in
//! seconds `ROLLTANK_LONG_S`.

use std::env;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use devices::Quantity::{Force, Roll, Speed};
use devices::{Device, Reading};
use replay::{Columns, Exit, LocalDisk, Player, Provenance, Recorder, import};

use crate::recorded_days::{live, records};
use crate::recordings::{columns, folder};

/// What a reader may take, of which the process itself needs about 5.
const MEMORY_MAX_MB: f64 = 200.0;
/// Names the file to the process that reads it.
const FILE: &str = "ROLLTANK_BIG_FILE";

/// Writes a table of about a size, with a clock of 1 kHz; the samples in it.
fn write_table(path: &Path, megabytes: u64) -> u64 {
    let mut file = BufWriter::new(File::create(path).expect("it can be made"));
    let (mut written, mut rows) = (0, 0_u32);
    writeln!(file, "t,roll,force,speed").expect("the disk has room");
    while written < megabytes << 20 {
        let time_s = f64::from(rows) / 1000.0;
        let roll = (2.4 * time_s).sin() / 7.0;
        let line = format!("{time_s:.3},{roll:.9},{:.6},1.2345\n", 50.0 * roll);
        file.write_all(line.as_bytes()).expect("the disk has room");
        written += line.len() as u64;
        rows += 1;
    }
    file.flush().expect("the disk has room");
    3 * u64::from(rows)
}

/// Does something with a file in a process of its own; the numbers that it tells by name.
fn run_apart(child: &str, path: &Path) -> impl Fn(&str) -> f64 {
    let (_, module) = module_path!().split_once("::").expect("the crate comes first");
    let output = Command::new(env::current_exe().expect("this program has a path"))
        .args(["--exact", &format!("{module}::{child}"), "--ignored", "--nocapture"])
        .env(FILE, path)
        .output()
        .expect("this program runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}");
    move |name: &str| -> f64 {
        let found = text.split_whitespace().find_map(|word| word.strip_prefix(name));
        let found = found.and_then(|number| number.strip_prefix('='));
        found.expect("the child tells").parse().expect("it is a number")
    }
}

/// Reads a file in a process of its own: samples and peak memory [MB].
fn read_apart(path: &Path) -> (u64, f64) {
    let number = run_apart("child_that_reads_the_file", path);
    (number("samples") as u64, number("peak_kb") / 1024.0)
}

/// The most memory that this process has had at once [kB].
fn peak_kb() -> u64 {
    let status = fs::read_to_string("/proc/self/status").expect("this is Linux");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak = peak.and_then(|peak| peak.split_whitespace().next()).expect("Linux tells the peak");
    peak.parse().expect("it is a number")
}

fn channels() -> Columns {
    columns(&[Roll, Force, Speed])
}

#[test]
#[ignore = "run by the stories beside it, in a process of its own"]
fn child_that_reads_the_file() {
    let path = PathBuf::from(env::var_os(FILE).expect("the story names the file"));
    let mut player = Player::open("big", &[(None, path)], &channels()).expect("it opens");
    let (mut samples, mut count) = (Vec::new(), 0);
    loop {
        let reading = player.read(&mut samples).expect("it can be read");
        count += samples.len();
        samples.clear();
        if reading == Reading::Ended {
            break;
        }
    }
    println!("\nsamples={count} peak_kb={}", peak_kb());
}

/// Size of the big table [MB].
fn megabytes() -> u64 {
    env::var("ROLLTANK_BIG_CSV_MB")
        .map_or(200, |text| text.parse().expect("ROLLTANK_BIG_CSV_MB is a number of megabytes"))
}

#[test]
fn a_big_table_is_read_in_little_memory() {
    let megabytes = megabytes();
    let folder = folder();
    let path = folder.path().join("big.csv");
    let written = write_table(&path, megabytes);
    let (samples, peak_mb) = read_apart(&path);
    println!("{megabytes} MB table: {samples} samples read in {peak_mb:.1} MB");
    assert_eq!(samples, written);
    assert!(peak_mb < MEMORY_MAX_MB, "{peak_mb} MB");
}

#[test]
fn a_long_recording_is_imported_and_read_in_little_memory() {
    // A leak of every sample would take 24 bytes each, 30 MB here, above a reader's own 8 MB.
    let folder = folder();
    let (table, target) = (folder.path().join("long.csv"), folder.path().join("long.mcap"));
    let written = write_table(&table, megabytes().div_ceil(13));
    import("long", &[(None, table)], &channels(), &target, "", &mut |_, _| {})
        .expect("the import succeeds");
    let (samples, peak_mb) = read_apart(&target);
    println!("MCAP of {written} samples read in {peak_mb:.1} MB");
    assert_eq!(samples, written);
    assert!(peak_mb < 30.0, "{peak_mb} MB");
}

#[test]
#[ignore = "run by the story beside it, in a process of its own"]
fn child_that_records_for_long() {
    let target = PathBuf::from(env::var_os(FILE).expect("the story names the file"));
    let instants = 1000
        * env::var("ROLLTANK_LONG_S").map_or(120, |text| {
            text.parse::<u64>().expect("ROLLTANK_LONG_S is a number of seconds")
        });
    let mut recorder =
        Recorder::start(&target, &Provenance::default(), live(), Box::new(LocalDisk))
            .expect("it starts");
    let mut early_kb = 0;
    for instant in 0..instants {
        for record in records(instant) {
            recorder.push(record).expect("it is recorded");
        }
        recorder.tick(Duration::from_millis(instant)).expect("the disk has room");
        if instant == instants / 10 {
            early_kb = peak_kb();
        }
    }
    let late_kb = peak_kb();
    let finished = recorder.finish(Exit::success("it was long enough")).expect("it is finished");
    let samples: u64 = finished.samples.iter().map(|(_, samples)| samples).sum();
    println!("\nsamples={samples} early_kb={early_kb} late_kb={late_kb} peak_kb={}", peak_kb());
}

#[test]
fn a_long_recording_is_made_in_memory_that_does_not_grow() {
    let folder = folder();
    let target = folder.path().join("long.mcap");
    let told = run_apart("child_that_records_for_long", &target);
    let mb = |name| told(name) / 1024.0;
    println!(
        "{} samples: {:.1} MB after a tenth of them, {:.1} MB after all, {:.1} MB when finished",
        told("samples"),
        mb("early_kb"),
        mb("late_kb"),
        mb("peak_kb")
    );
    assert!(mb("late_kb") < mb("early_kb") + 0.5, "recording takes no more as it goes on");
    assert!(mb("peak_kb") < 30.0, "nor does finishing");
}
