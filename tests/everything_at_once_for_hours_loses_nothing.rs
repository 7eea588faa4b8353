//! Fast instruments through drivers, recorder, run finder and page for as long as one likes: every
//! sample is in the recording, and memory stays flat.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use devices::Attachment;
use devices::driver::{Decoded, Session};
use devices::port::LinkEvent;
use replay::{Record, Recorded};

use super::campaign_folder::rolltank;
use super::live_tank::{Daemon, FAST, LiveTank};

/// Four fields at 2 kHz in binary, and eight at 100 Hz as text; a campaign measures three of them.
const DEVICES: &str = r#"[exciter]
moment_arm_m = 0.43
[[device]]
name = "fast board"
profile = "cobs-board"
port = "PORTS/fast"
settings = { fields = 4 }
[[device.channel]]
quantity = "roll"
field = 0
calibration = { curve = { gain = 1e-5 } }
[[device.channel]]
quantity = "force"
field = 1
calibration = { curve = { gain = 1e-2 } }
[[device]]
name = "slow board"
profile = "arduino-text"
port = "PORTS/slow"
baud = 921600
settings = { pattern = "$RD,{sequence},{time_us},{0},{1},{2},{3},{4},{5},{6},{7}*{xor}" }
[[device.channel]]
quantity = "speed"
field = 0
calibration = { curve = { gain = 1e-3 } }
"#;

/// What the raw bytes of one device say: frames, values in them, and numbers missing between them.
#[derive(Debug, Default)]
struct Read {
    n_frames: u64,
    n_values: u64,
    n_missing: u64,
    n_damaged: u64,
    last: Option<u64>,
}

impl Read {
    fn take(&mut self, decoded: &[Decoded]) {
        for what in decoded {
            match what {
                Decoded::Values { values, sequence, .. } => {
                    let sequence = sequence.expect("these boards count");
                    self.n_missing += self.last.map_or(0, |last| sequence - last - 1);
                    self.last = Some(sequence);
                    self.n_frames += 1;
                    self.n_values += values.len() as u64;
                }
                Decoded::Damaged { .. } => self.n_damaged += 1,
                _ => {}
            }
        }
    }
}

/// Decodes the raw bytes of a recording, device by device; the samples beside them are counted.
fn read_back(recording: &Path) -> (BTreeMap<String, Read>, BTreeMap<&'static str, u64>) {
    let mut recorded = Recorded::open(recording).expect("it is whole");
    let (mut devices, mut samples) = (BTreeMap::new(), BTreeMap::new());
    let mut sessions: BTreeMap<String, Session> = BTreeMap::new();
    while let Some(record) = recorded.next_record().expect("it can be read") {
        match record {
            Record::Device(device) => {
                let attachment = Attachment::from_text(&device.settings).expect("it is ours");
                let (session, _) = attachment.start().expect("its driver takes it");
                sessions.insert(device.device.clone(), session);
                devices.insert(device.device, Read::default());
            }
            Record::Raw(raw) => {
                let (session, read) =
                    (sessions.get_mut(&*raw.device), devices.get_mut(&*raw.device));
                let (session, read) = session.zip(read).expect("it was attached");
                let mut decoded = Vec::new();
                match raw.link_event() {
                    Some(LinkEvent::Opened { at_ns }) => session.open(at_ns),
                    Some(LinkEvent::Received { at_ns, bytes, .. }) => {
                        session.receive(&bytes, at_ns, &mut decoded);
                    }
                    // It was asked who it is.
                    Some(LinkEvent::Sent { .. }) => {}
                    other => panic!("{other:?}"),
                }
                read.take(&decoded);
            }
            Record::Sample(sample) => *samples.entry(sample.quantity.name()).or_default() += 1,
            Record::Gap(_) | Record::Loss(_) => panic!("{record:?}"),
            _ => {}
        }
    }
    (devices, samples)
}

#[expect(clippy::disallowed_methods, reason = "a soak is measured in the world's time")]
fn soak(tank: &LiveTank, duration_s: f64) -> String {
    let mut daemon = Daemon::start(tank, &[]);
    daemon.wait_for("linked", 2);
    let start = Instant::now();
    // Largest memory in each quarter, and the processor time after the first.
    let mut quarters = [0.0_f64; 4];
    let mut settled = None;
    while start.elapsed().as_secs_f64() < duration_s {
        std::thread::sleep(Duration::from_millis(250));
        let share = start.elapsed().as_secs_f64() / duration_s;
        let quarter = ((4.0 * share) as usize).min(3);
        quarters[quarter] = quarters[quarter].max(daemon.resident_mb());
        if quarter > 0 {
            settled.get_or_insert_with(|| (Instant::now(), daemon.cpu_s()));
        }
    }
    let (since, before_s) = settled.expect("a quarter passed");
    let cpu = (daemon.cpu_s() - before_s) / since.elapsed().as_secs_f64();
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let recordings = tank.files("live", ".mcap");
    assert_eq!(recordings.len(), 1, "{said}");
    let (devices, samples) = read_back(&recordings[0]);
    for read in devices.values() {
        assert_eq!((read.n_missing, read.n_damaged), (0, 0), "{devices:?}");
    }
    let (fast, slow) = (&devices[FAST], &devices["slow board"]);
    assert_eq!((fast.n_values, slow.n_values), (4 * fast.n_frames, 8 * slow.n_frames));
    assert_eq!((samples["roll"], samples["force"]), (fast.n_frames, fast.n_frames));
    assert_eq!(samples["speed"], slow.n_frames);
    assert!(fast.n_frames as f64 > 0.95 * 2000.0 * duration_s, "{devices:?}");
    assert!(slow.n_frames as f64 > 0.95 * 100.0 * duration_s, "{devices:?}");
    let [_, second_mb, third_mb, last_mb] = quarters;
    let n_runs = said.matches("run found").count();
    // What a diagnosis works with comes and goes; whatever stays of a run would be in the last.
    assert!(last_mb < second_mb.max(third_mb) + 4.0, "{quarters:?} MB, {n_runs} runs");
    let live = tank.text("results/identification.json");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
    format!(
        "{duration_s} s: {} binary and {} text samples in the recording, none lost; {} runs; \
         daemon: CPU {:.1} % of a core, memory at most {second_mb:.1} MB in the second quarter, \
         {third_mb:.1} MB in the third and {last_mb:.1} MB in the last",
        fast.n_values,
        slow.n_values,
        n_runs,
        100.0 * cpu
    )
}

#[test]
fn ten_seconds_of_everything_are_all_in_the_recording() {
    println!("{}", soak(&LiveTank::of_devices(DEVICES), 10.0));
}

/// `cargo test --test stories -- --ignored --nocapture minutes_of_everything_are`.
#[test]
#[ignore = "takes ten minutes; the same is tested for seconds above"]
fn ten_minutes_of_everything_are_all_in_the_recording() {
    println!("{}", soak(&LiveTank::calm_of_devices(DEVICES), 600.0));
}

/// The same with a decay in every 40 s: `-- --ignored --nocapture and_its_runs`.
#[test]
#[ignore = "takes ten minutes"]
fn ten_minutes_of_everything_and_its_runs_are_all_in_the_recording() {
    println!("{}", soak(&LiveTank::of_devices(DEVICES), 600.0));
}
