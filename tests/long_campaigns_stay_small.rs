//! A day of recording is replayed in the memory of a short one, its runs found and reported.
//!
//! The size of the table in megabytes is `ROLLTANK_BIG_CSV_MB`.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use rolltank::campaign;
use rolltank::pipeline::{self, Learnt, Observed, Options};

use super::campaign_folder::{CampaignFolder, decay};

/// What the whole program may take, of which a short recording needs about 20.
const MEMORY_MAX_MB: f64 = 200.0;
/// Repeats of three still seconds after each decay: ten minutes.
const STILL_REPEATS: u32 = 200;

/// Repeats a decay, and the still water before it, until the table has its size; the decays in it.
fn write_table(path: &Path, megabytes: u64) -> usize {
    let decay = decay(0.0);
    let roll: Vec<&str> = decay.lines().skip(1).filter_map(|row| row.split(',').nth(1)).collect();
    let still = &roll[..300];
    let mut file = BufWriter::new(File::create(path).expect("it can be made"));
    file.write_all(b"t,roll\n").expect("the disk has room");
    let (mut written, mut row, mut n_decays, mut line) = (0, 0_u32, 0, String::new());
    while written < megabytes << 20 {
        let quiet = (0..STILL_REPEATS).flat_map(|_| still.iter());
        for value in roll.iter().chain(quiet) {
            line.clear();
            writeln!(line, "{:.2},{value}", f64::from(row) * 0.01).expect("memory has room");
            file.write_all(line.as_bytes()).expect("the disk has room");
            written += line.len() as u64;
            row += 1;
        }
        n_decays += 1;
    }
    file.flush().expect("the disk has room");
    n_decays
}

/// Peak memory of a process so far [MB]; none once it has ended.
fn peak_mb(process: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes / 1024.0)
}

#[test]
fn a_long_recording_is_replayed_in_bounded_memory() {
    let megabytes = std::env::var("ROLLTANK_BIG_CSV_MB").ok().and_then(|mb| mb.parse().ok());
    let campaign = CampaignFolder::new();
    let n_decays = write_table(&campaign.path().join("pass_01.csv"), megabytes.unwrap_or(30));
    let mut child = Command::new(env!("CARGO_BIN_EXE_rolltank"))
        .current_dir(campaign.path())
        .args(["replay", ".", "--json"])
        .stdout(File::create(campaign.path().join("out.json")).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut peak = None;
    let ended = loop {
        peak = peak_mb(child.id()).or(peak);
        if let Some(ended) = child.try_wait().unwrap() {
            break ended;
        }
        thread::sleep(Duration::from_millis(20));
    };
    assert_eq!(ended.code(), Some(0));
    let json = fs::read(campaign.path().join("out.json")).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
    assert_eq!(json["runs"].as_array().unwrap().len(), n_decays);
    // Systems without /proc keep no such book.
    if let Some(peak) = peak {
        println!("{n_decays} runs, peak memory {peak:.0} MB");
        assert!(peak < MEMORY_MAX_MB, "{peak:.0} MB");
    }
}

#[test]
fn what_a_diagnosis_reads_of_a_run_waits_on_disk_and_says_the_same() {
    let folder = CampaignFolder::new();
    let campaign = campaign::read(folder.path()).expect("it is good");
    let mut in_memory = Observed::default();
    let mut on_disk = Observed::on_disk(&folder.path().join("results")).expect("there is a disk");
    let mut hear = |learnt: Learnt<'_>| {
        in_memory.hear(learnt, &campaign);
        on_disk.hear(learnt, &campaign);
        Ok(())
    };
    pipeline::replay(&campaign, &Options::default(), &mut |_| {}, &mut hear).expect("it plays");
    assert_eq!(on_disk.n_heard(), 1);
    assert!(in_memory.series_bytes() > 5_000, "{} bytes", in_memory.series_bytes());
    assert_eq!(on_disk.series_bytes(), 0);
    let said = [in_memory, on_disk].map(|observed| observed.diagnosed(&campaign));
    assert!(said[0].is_some() && said[0] == said[1]);
}
