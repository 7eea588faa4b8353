//! One recording follows another on open links: every frame of the boards is in one of the two.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use devices::driver::{Decoded, Session};
use devices::port::LinkEvent;
use devices::{Attachment, Device, Quantity, Reading};
use replay::{Columns, Direction, Gap, Player, Record, Recorded};

use super::campaign_folder::rolltank;
use super::http::post;
use super::live_tank::{Daemon, LiveTank};

/// What a recording holds of its own, and what it repeats of the one before.
#[derive(Debug, Default)]
struct Held {
    /// Sequence numbers of each device: its own frames.
    own: BTreeMap<String, Vec<u64>>,
    /// Frames that it repeats.
    n_repeated: usize,
    /// Time of its samples [s] and their values, to the bit.
    samples: BTreeMap<Quantity, Vec<(u64, u64)>>,
    gaps: Vec<Gap>,
}

/// Decodes the raw bytes of a recording.
fn held(recording: &Path) -> Held {
    let mut recorded = Recorded::open(recording).expect("it is whole");
    let mut held = Held::default();
    let mut sessions: BTreeMap<String, (Session, bool)> = BTreeMap::new();
    while let Some(record) = recorded.next_record().expect("it can be read") {
        match record {
            Record::Device(device) => {
                let attachment = Attachment::from_text(&device.settings).expect("it is ours");
                let (session, _) = attachment.start().expect("its driver takes it");
                sessions.insert(device.device, (session, true));
            }
            Record::Raw(raw) => {
                let (session, is_own) = sessions.get_mut(&*raw.device).expect("it was attached");
                let mut decoded = Vec::new();
                match raw.link_event() {
                    None => *is_own = raw.direction == Direction::Begun,
                    Some(LinkEvent::Opened { at_ns }) => session.open(at_ns),
                    Some(LinkEvent::Round { due_ns, .. }) => session.join(due_ns),
                    Some(LinkEvent::Received { at_ns, bytes, .. }) => {
                        session.receive(&bytes, at_ns, &mut decoded);
                    }
                    Some(LinkEvent::Sent { at_ns, .. }) => {
                        session.poll(at_ns, &mut Vec::new(), &mut decoded);
                    }
                    Some(_) => {}
                }
                for what in decoded {
                    let Decoded::Values { sequence: Some(sequence), .. } = what else { continue };
                    if *is_own {
                        held.own.entry(raw.device.to_string()).or_default().push(sequence);
                    } else {
                        held.n_repeated += 1;
                    }
                }
            }
            Record::Sample(sample) => {
                let bits = (sample.time_s.to_bits(), sample.value.to_bits());
                held.samples.entry(sample.quantity).or_default().push(bits);
            }
            Record::Gap(gap) => held.gaps.push(gap),
            _ => {}
        }
    }
    held
}

/// Samples as a replay of that recording alone brings them.
fn replayed(recording: &Path) -> BTreeMap<Quantity, Vec<(u64, u64)>> {
    let files = [(None, recording.to_owned())];
    let mut player = Player::open("alone", &files, &Columns::default()).expect("it opens");
    let mut samples = Vec::new();
    while player.read(&mut samples).expect("it plays") == Reading::More {}
    let mut all: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for sample in samples {
        let bits = (sample.time_s.to_bits(), sample.value.to_bits());
        all.entry(sample.quantity).or_default().push(bits);
    }
    all
}

/// Recordings each of which goes on where the one before has ended.
fn follow_each_other(recordings: &[PathBuf], said: &str) -> Vec<Held> {
    let all: Vec<Held> = recordings.iter().map(|recording| held(recording)).collect();
    for (recording, held) in recordings.iter().zip(&all) {
        let name = recording.display();
        assert!(replayed(recording) == held.samples, "{name} replays as it was: {said}");
        let n_frames: usize = held.own.values().map(Vec::len).sum();
        let n_samples: usize = held.samples.values().map(Vec::len).sum();
        assert_eq!(n_frames, n_samples, "a sample of each frame, and none of a repeated: {said}");
    }
    for pair in all.windows(2) {
        assert!(pair[1].n_repeated > 0, "it brings the clocks with it");
        for (device, before) in &pair[0].own {
            let after = &pair[1].own[device];
            assert_eq!(before.last().map(|last| last + 1), after.first().copied(), "{device}");
        }
        for (quantity, before) in &pair[0].samples {
            let [last_s, first_s] = [before.last(), pair[1].samples[quantity].first()]
                .map(|sample| f64::from_bits(sample.expect("some came").0));
            // 10 ms from one to the next, and the two clocks' lines differ by little.
            assert!((first_s - last_s - 0.01).abs() < 0.05, "{quantity:?}: {last_s}, {first_s}");
        }
    }
    for numbers in all.iter().flat_map(|held| held.own.values()) {
        assert!(numbers.windows(2).all(|pair| pair[0] + 1 == pair[1]), "{numbers:?}: {said}");
    }
    all
}

#[test]
fn a_recording_that_gives_way_for_its_length_loses_no_frame() {
    let tank = LiveTank::calm_at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &["--rotate", "0.6"]);
    daemon.wait_for("session begun", 3);
    std::thread::sleep(std::time::Duration::from_millis(300));
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(said.matches("linked").count(), 2, "its ports stayed open: {said}");
    let recordings = tank.files("live", ".mcap");
    assert_eq!(recordings.len(), 3, "{said}");
    let all = follow_each_other(&recordings, &said);
    assert!(all.iter().all(|held| held.gaps.is_empty()), "{all:?}");
}

#[test]
fn a_pause_or_another_campaign_file_loses_no_frame_and_another_instrument_leaves_a_gap() {
    let tank = LiveTank::calm_at_speed(8.0);
    let mut daemon = Daemon::start(&tank, &[]);
    let address = daemon.address();
    daemon.wait_for("linked", 2);
    let breathe = || std::thread::sleep(std::time::Duration::from_millis(400));
    breathe();
    tank.edit("condition = \"bare hull\"", "condition = \"bilge keels\"");
    tank.edit("gain = 1e-3", "gain = 1.5e-3");
    daemon.signal("-HUP");
    daemon.wait_for("session begun", 2);
    breathe();
    for (what, n_begun) in [("stop_recording", 3), ("start_recording", 4)] {
        let wish = format!("{{\"by\": \"C. Costa\", \"what\": \"{what}\"}}");
        assert_eq!(post(&address, "/act", &[], &wish).status, 200, "{what}");
        daemon.wait_for("session begun", n_begun);
    }
    breathe();
    assert_eq!(daemon.said().matches("linked").count(), 2, "{}", daemon.said());
    tank.edit(
        "[[device]]\nname = \"carriage\"",
        "[[device]]\nlag = { kind = \"delay\", time_s = 0.001 }\nname = \"carriage\"",
    );
    daemon.signal("-HUP");
    daemon.wait_for("linked", 4);
    breathe();
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let recordings = tank.files("live", ".mcap");
    let [first, second, third, other] = &recordings[..] else { panic!("{recordings:?}: {said}") };
    follow_each_other(&[first, second, third].map(Clone::clone), &said);
    let other = held(other);
    assert_eq!(other.n_repeated, 0, "{said}");
    for channel in ["roll", "speed"] {
        let gap = other.gaps.iter().find(|gap| gap.channel == channel).expect("a gap");
        assert!(gap.reason.contains("opened anew") && gap.start_s < gap.end_s, "{gap:?}");
    }
    let live = tank.text("results/identification.json");
    let replayed = rolltank(tank.path(), &["identify", ".", "--json"]);
    assert_eq!(replayed.out, live, "{said}");
}
