//! The Arduino sketch in `devices/arduino`, compiled for this machine, sends what the driver reads.

use std::path::Path;
use std::process::Command;

use devices::driver::{Decoded, Session};

use crate::wire::session;

/// As much of an Arduino as the sketch needs; its serial port is standard output.
const ARDUINO_H: &str = r"
#include <cstdint>
#include <cstdio>
#include <cstring>
static const uint8_t A0 = 14, A1 = 15;
// Just before micros() wraps, so that the sketch has to continue it.
static uint64_t clock_us = 4294960000ull;
static uint32_t micros() { return (uint32_t)(clock_us += 100); }
static int analogRead(uint8_t pin) { return pin == A0 ? 0 : 1023; }
static struct {
  void begin(uint32_t) {}
  // The host asks once who it is: the zero that ends its frame is what counts.
  int asked = 0;
  int available() { return clock_us > 4295100000ull && asked == 0; }
  int read() { asked = 1; return 0; }
  void write(const uint8_t *bytes, uint8_t n) { fwrite(bytes, 1, n, stdout); }
} Serial;
";

const MAIN: &str = r#"
#include "Arduino.h"
#include "cobs_board.ino"
int main() {
  setup();
  while (sequence < 100) loop();
  return 0;
}
"#;

/// What the sketch sends in half a second; none without a compiler.
fn sent() -> Option<Vec<u8>> {
    let sketch = Path::new(env!("CARGO_MANIFEST_DIR")).join("arduino/cobs_board");
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text| std::fs::write(folder.path().join(name), text);
    write("Arduino.h", ARDUINO_H).and(write("main.cpp", MAIN)).expect("files are written");
    let program = folder.path().join("board");
    let mut compile = Command::new("c++");
    compile.args(["-std=c++17", "-Wall", "-I"]).arg(folder.path()).arg("-I").arg(sketch);
    compile.arg(folder.path().join("main.cpp")).arg("-o").arg(&program);
    match compile.output() {
        Ok(output) if output.status.success() => {}
        Ok(output) => panic!("{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) if std::env::var_os("CI").is_none() => {
            eprintln!("skipped: no C++ compiler here: {error}");
            return None;
        }
        Err(error) => panic!("no C++ compiler: {error}"),
    }
    Some(Command::new(program).output().expect("the board runs").stdout)
}

#[test]
fn its_samples_identity_and_continued_time_come_back() {
    let Some(bytes) = sent() else { return };
    let mut session: Session = session("cobs", "fields = 2");
    session.open(0);
    let mut decoded = Vec::new();
    session.receive(&bytes, 1, &mut decoded);
    let (mut n_frames, mut identities, mut last_us) = (0, Vec::new(), 0);
    for what in decoded {
        match what {
            Decoded::Values { values, sequence, ticks, .. } => {
                let raws: Vec<f64> = values.iter().map(|value| value.raw).collect();
                assert_eq!((raws, sequence), (vec![0.0, 1023.0], Some(n_frames)));
                let time_us = ticks.expect("the board stamps");
                assert!(n_frames == 0 || (4000..6000).contains(&(time_us - last_us)), "{time_us}");
                (n_frames, last_us) = (n_frames + 1, time_us);
            }
            Decoded::Identity(text) => identities.push(text),
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(n_frames, 100);
    assert!(last_us > 1 << 32, "the time went on beyond the wrap: {last_us}");
    assert_eq!(identities, ["rolltank-board 1", "rolltank-board 1"]);
}
