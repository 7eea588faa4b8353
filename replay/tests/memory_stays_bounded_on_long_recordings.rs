//! A recording of any length is read in the same small memory.
//!
//! The reader runs as a process of its own, so that its peak memory is its own too. Its size in
//! megabytes is `ROLLTANK_BIG_CSV_MB`.

use std::env;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use devices::Quantity::{Force, Roll, Speed};
use devices::{Device, Reading};
use replay::{Columns, Player, import};

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

/// Reads a file in a process of its own: samples and peak memory [MB].
fn read_apart(path: &Path) -> (u64, f64) {
    let child = concat!(module_path!(), "::child_that_reads_the_file");
    let (_, child) = child.split_once("::").expect("the crate comes first");
    let output = Command::new(env::current_exe().expect("this program has a path"))
        .args(["--exact", child, "--ignored", "--nocapture"])
        .env(FILE, path)
        .output()
        .expect("this program runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}");
    let number = |key: &str| -> f64 {
        let found = text.split_whitespace().find_map(|word| word.strip_prefix(key));
        found.expect("the child tells").parse().expect("it is a number")
    };
    (number("samples=") as u64, number("peak_kb=") / 1024.0)
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
    let status = fs::read_to_string("/proc/self/status").expect("this is Linux");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak = peak.and_then(|peak| peak.split_whitespace().next()).expect("Linux tells the peak");
    println!("\nsamples={count} peak_kb={peak}");
}

#[test]
fn a_big_table_is_read_in_little_memory() {
    let megabytes = env::var("ROLLTANK_BIG_CSV_MB")
        .map_or(200, |text| text.parse().expect("ROLLTANK_BIG_CSV_MB is a number of megabytes"));
    let folder = folder();
    let path = folder.path().join("big.csv");
    let written = write_table(&path, megabytes);
    let (samples, peak_mb) = read_apart(&path);
    println!("{megabytes} MB table: {samples} samples read in {peak_mb:.1} MB");
    assert_eq!(samples, written);
    assert!(peak_mb < MEMORY_MAX_MB, "{peak_mb} MB");
}

#[test]
fn a_recording_of_ten_hours_is_imported_and_read_in_little_memory() {
    // Ten hours at 100 Hz are 3.6 million rows; a tenth tells a leak per sample just as well, as
    // it would show as 30 MB and the limit is set below that.
    let folder = folder();
    let (table, target) = (folder.path().join("long.csv"), folder.path().join("long.mcap"));
    let written = write_table(&table, 15);
    import("long", &[(None, table)], &channels(), &target, "", &mut |_, _| {})
        .expect("the import succeeds");
    let (samples, peak_mb) = read_apart(&target);
    println!("MCAP of {written} samples read in {peak_mb:.1} MB");
    assert_eq!(samples, written);
    assert!(peak_mb < 30.0, "{peak_mb} MB");
}
