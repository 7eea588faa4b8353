//! An emulated instrument waits for a program that is slow, and for none that is not there.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use devices::clock::WallClock;
use devices::emulator::{EmulatedPort, emulator};

use crate::bench::{channels, device, swing};

const RATE_HZ: f64 = 4000.0;
/// Far longer than a terminal holds at this rate.
const AWAY: Duration = Duration::from_millis(1500);

fn plugged_in() -> (tempfile::TempDir, EmulatedPort) {
    let pattern = "[settings]\npattern = \"$A,{sequence},{0}*{xor}\"\n";
    let lines = format!("baud = 2000000\n{pattern}{}", channels(1));
    let (folder, config) = device("arduino-text", &lines);
    let board = emulator(&config.driver, &config.settings, RATE_HZ, Box::new(swing));
    let board = board.expect("the settings are good");
    let clock = Arc::new(WallClock::start());
    let port = EmulatedPort::plug_in(&config.port, board, config.line.byte_ns(), clock);
    (folder, port.expect("a pseudo-terminal"))
}

/// Sequence numbers of the next lines.
fn sequences(lines: &mut BufReader<File>, n_lines: usize) -> Vec<u64> {
    let lines = lines.lines().take(n_lines).map(|line| line.expect("the port is there"));
    let number = |line: String| line.split(',').nth(1).and_then(|number| number.parse().ok());
    lines.map(|line| number(line.clone()).unwrap_or_else(|| panic!("{line}"))).collect()
}

#[test]
fn a_program_that_is_kept_from_reading_gets_everything_later() {
    let (_folder, port) = plugged_in();
    let mut lines = BufReader::new(File::open(port.path()).expect("it is there"));
    let first = sequences(&mut lines, 10)[9];
    thread::sleep(AWAY);
    let later = sequences(&mut lines, 8000);
    let expected: Vec<u64> = (first + 1..=first + 8000).collect();
    assert!(later == expected, "from {} to {}", later[0], later[7999]);
}

#[test]
fn a_port_that_nobody_has_open_keeps_nothing() {
    let (_folder, port) = plugged_in();
    drop(BufReader::new(File::open(port.path()).expect("it is there")));
    thread::sleep(AWAY);
    let mut lines = BufReader::new(File::open(port.path()).expect("it is there"));
    // Of the time away, only what lay in the terminal when the port was closed may come.
    let number = sequences(&mut lines, 1000)[999];
    assert!(number > 5000, "{number}");
}
