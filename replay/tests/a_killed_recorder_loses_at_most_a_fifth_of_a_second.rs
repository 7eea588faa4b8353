//! A recorder is killed in the middle of its work, again and again, and its recordings come back.
//!
//! The recorder runs as a process of its own with a thread that acquires and a thread that writes,
//! as the daemon has them. It tells each instant before it hands it on, so what it told and what is
//! found afterwards differ by exactly what was lost. `ROLLTANK_KILLS` is the number of kills.

use std::collections::BTreeMap;
use std::env;
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use replay::{
    Exit, ExitStatus, Fate, LocalDisk, Orphan, Provenance, Record, Recorded, Recorder, RunStop,
    recover,
};

use crate::recorded_days::{
    RATE_HZ, RUN_INSTANTS, instants_kept, live, names, read, records, result, run_start, time_s,
};
use crate::recordings::folder;

/// Names the folder to the process that records.
const FOLDER: &str = "ROLLTANK_KILLED_FOLDER";
/// What a crash may take of each channel.
const LOST_INSTANTS_MAX: u64 = RATE_HZ / 5;

#[expect(clippy::disallowed_methods, reason = "the recorder is killed in real time")]
fn now() -> Instant {
    Instant::now()
}

/// The nth of a row of numbers that look drawn by lot, the same ones in every run.
fn lot(number: u64) -> u64 {
    let mixed = (number + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed ^ (mixed >> 29)
}

/// Tells the story a line at once, so that no kill can take it back.
fn tell(line: &str) {
    io::stdout().lock().write_all(format!("{line}\n").as_bytes()).expect("the story listens");
}

/// Hands on everything of one recording as its time comes.
fn acquire(recording: u64, queue: &SyncSender<Vec<Record>>) {
    let started = now();
    for instant in 0..300 + lot(recording) % 900 {
        while started.elapsed().as_secs_f64() < time_s(instant) {
            thread::sleep(Duration::from_millis(1));
        }
        tell(&format!("acquired {recording} {instant}"));
        queue.send(records(instant)).expect("the writer lives");
    }
}

#[test]
#[ignore = "run by the story beside it, in a process of its own"]
fn child_that_records_until_it_is_killed() {
    let folder = PathBuf::from(env::var_os(FOLDER).expect("the story names the folder"));
    let started = now();
    tell("");
    for recording in 0.. {
        let target = folder.join(format!("pass_{recording}.mcap"));
        let mut recorder =
            Recorder::start(&target, &Provenance::default(), live(), Box::new(LocalDisk))
                .expect("it starts");
        let (queue, waiting) = sync_channel(1024);
        let acquiring = thread::spawn(move || acquire(recording, &queue));
        loop {
            let arrived = match waiting.recv_timeout(Duration::from_millis(5)) {
                Ok(arrived) => arrived,
                Err(RecvTimeoutError::Timeout) => Vec::new(),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            for record in arrived {
                let run = match &record {
                    Record::Result(result) => Some(result.run.clone()),
                    _ => None,
                };
                recorder.push(record).expect("it is recorded");
                if let Some(run) = run {
                    tell(&format!("identified {recording} {run}"));
                }
            }
            recorder.tick(started.elapsed()).expect("the disk has room");
        }
        acquiring.join().expect("it ends by itself");
        tell(&format!("ending {recording} 0"));
        recorder.finish(Exit::success("the pass is over")).expect("it is finished");
        tell(&format!("finished {recording} 0"));
    }
}

/// What the killed process told of one recording.
#[derive(Debug, Default)]
struct Told {
    instants: u64,
    runs: Vec<u64>,
    is_ending: bool,
    is_finished: bool,
}

/// When a recorder is killed.
#[derive(Debug, Clone, Copy)]
enum Moment {
    /// So long after its first sample.
    Recording(Duration),
    /// So long after it began to finish its first recording.
    Finishing(Duration),
}

impl Moment {
    fn by_lot(kill: u64) -> Self {
        let lot = lot(1000 + kill);
        if kill % 4 == 3 {
            return Self::Finishing(Duration::from_micros(lot % 15_000));
        }
        Self::Recording(Duration::from_micros(lot % 1_800_000))
    }
}

/// Lets a recorder record for a while and kills it; what it told of each recording.
fn record_and_kill(folder: &Path, moment: Moment) -> BTreeMap<u64, Told> {
    let child = concat!(module_path!(), "::child_that_records_until_it_is_killed");
    let (_, child) = child.split_once("::").expect("the crate comes first");
    let mut process = Command::new(env::current_exe().expect("this program has a path"))
        .args(["--exact", child, "--ignored", "--nocapture"])
        .env(FOLDER, folder)
        .stdout(Stdio::piped())
        .spawn()
        .expect("this program runs");
    let mut output = BufReader::new(process.stdout.take().expect("it is piped"));
    let mut line = String::new();
    while !line.starts_with("acquired") {
        line.clear();
        let read = output.read_line(&mut line).expect("it is text");
        assert!(read > 0, "the recorder starts");
    }
    let (ending, ends) = sync_channel(1);
    let listening = thread::spawn(move || {
        let lines = output.lines().map_while(Result::ok).inspect(|line| {
            if line.starts_with("ending 0") {
                ending.send(()).expect("there is room for the one");
            }
        });
        std::iter::once(line).chain(lines).collect::<Vec<_>>()
    });
    thread::sleep(match moment {
        Moment::Recording(wait) => wait,
        Moment::Finishing(wait) => {
            ends.recv_timeout(Duration::from_mins(1)).expect("every recording ends");
            wait
        }
    });
    process.kill().expect("it can be killed");
    process.wait().expect("it is gone");
    let mut told: BTreeMap<u64, Told> = BTreeMap::new();
    for line in listening.join().expect("it listens to the end") {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |place: usize| words.get(place).and_then(|word| word.parse::<u64>().ok());
        let (Some(what), Some(recording)) = (words.first(), number(1)) else { continue };
        let told = told.entry(recording).or_default();
        match *what {
            "acquired" => told.instants = number(2).map_or(told.instants, |instant| instant + 1),
            "identified" => told.runs.extend(number(3)),
            "ending" => told.is_ending = true,
            "finished" => told.is_finished = true,
            other => panic!("{other}"),
        }
    }
    told
}

/// Instants lost of a recording, of which everything else is as it was told.
fn instants_lost(folder: &Path, recording: u64, told: &Told, orphans: &[Orphan]) -> u64 {
    let path = folder.join(format!("pass_{recording}.mcap"));
    let of_it = |orphan: &&Orphan| orphan.part.with_extension("") == path;
    let orphan = orphans.iter().find(of_it);
    if !path.exists() {
        let fate = orphan.map(|orphan| &orphan.fate);
        assert!(matches!(fate, None | Some(Fate::Empty)), "{fate:?}");
        assert!(told.runs.is_empty(), "nothing of an empty recording was identified");
        return told.instants;
    }
    let records = read(&path);
    let kept = instants_kept(&records);
    let metadata = Recorded::open(&path).expect("it opens").metadata().clone();
    match orphan.map(|orphan| &orphan.fate) {
        None => assert_eq!(metadata["exit_status"], "success", "it was finished in time"),
        Some(Fate::Recovered(finished)) => {
            assert!(!told.is_finished);
            assert_eq!(finished.samples.iter().map(|(_, samples)| samples).min(), Some(&kept));
            let closed = finished.exit.status == ExitStatus::Success;
            assert!(closed || finished.exit.status == ExitStatus::Recovered);
            assert!(!closed || told.is_ending, "only who came to its end was closed");
        }
        Some(Fate::AlreadyFinished { .. }) => assert!(told.is_ending),
        Some(fate) => panic!("{fate:?}"),
    }
    if told.is_finished {
        assert_eq!(kept, told.instants, "a finished recording is whole");
    }
    let of_run = |run: u64| records.iter().filter(move |record| is_of(record, run));
    for run in 0..=kept / RUN_INSTANTS {
        let found: Vec<_> = of_run(run).collect();
        let known = |wanted: Record| found.contains(&&wanted);
        assert!(!told.runs.contains(&run) || known(Record::Result(result(run))), "run {run}");
        if !known(Record::RunStart(run_start(run))) {
            continue;
        }
        // Nobody ends the runs of this story, so that their ends are added.
        let stops = found.iter().filter_map(|record| match record {
            Record::RunStop(stop) => Some(stop),
            _ => None,
        });
        let stops: Vec<&RunStop> = stops.collect();
        assert_eq!(stops.len(), 1, "run {run} ends once: {found:?}");
        let counted: Vec<u64> = stops[0].counts.iter().map(|counts| counts.samples).collect();
        assert_eq!(counted.iter().min(), Some(&(kept - run * RUN_INSTANTS)), "from its start on");
    }
    told.instants.saturating_sub(kept)
}

fn is_of(record: &Record, number: u64) -> bool {
    let run = match record {
        Record::RunStart(start) => &start.run,
        Record::RunStop(stop) => &stop.run,
        Record::Result(result) => &result.run,
        _ => return false,
    };
    *run == format!("run {number}")
}

#[test]
fn whenever_it_is_killed_every_recording_comes_back_undamaged() {
    let kills = env::var("ROLLTANK_KILLS").map_or(12, |text| text.parse().expect("a number"));
    let mut lost: Vec<u64> = Vec::new();
    let (mut recordings, mut recovered, mut runs, mut midway) = (0, 0, 0, 0);
    for kill in 0..kills {
        let folder = folder();
        let moment = Moment::by_lot(kill);
        let told = record_and_kill(folder.path(), moment);
        let orphans = recover(folder.path(), &mut LocalDisk).expect("the folder can be read");
        assert!(orphans.len() <= 1, "{orphans:?}");
        for (recording, told) in &told {
            let missing = instants_lost(folder.path(), *recording, told, &orphans);
            assert!(missing <= LOST_INSTANTS_MAX, "kill {kill}, {moment:?}: {missing} lost");
            runs += told.runs.len();
            midway += u64::from(told.is_ending && !told.is_finished);
            lost.push(missing);
        }
        let left = names(folder.path());
        assert!(left.iter().all(|name| name.strip_suffix(".mcap").is_some()), "{left:?}");
        recordings += left.len();
        recovered += orphans.len();
    }
    let total: u64 = lost.iter().sum();
    let worst = lost.iter().max().expect("there were kills");
    println!(
        "{kills} kills: {recovered} of {recordings} recordings recovered, {midway} killed while \
         they were finished; lost of each channel at 1 kHz: worst {worst} ms, mean {:.1} ms a \
         kill; {runs} identified runs, all kept",
        total as f64 / kills as f64
    );
}
