//! A loop that stalls: what found no place is counted and a gap, and a replay is equal.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;
use std::time::Duration;

use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, emulator};
use devices::port::LinkEvent;
use devices::setup::DeviceConfig;
use devices::{AttachedInstrument, Device, Instrument, Quantity, Reading, Sample};
use replay::{Columns, Gap, LinkLosses, Player, Record, Recorded};

use super::attached::{Attached, Taken};
use super::keeping::Keeper;
use crate::campaign::{self, FILE_NAME};

const RATE_HZ: f64 = 500.0;
/// Events that may wait, and how long the loop stalls: three times as long as they last.
const EVENTS_WAITING: usize = 50;
const STALL: Duration = Duration::from_millis(300);

/// The campaign of one device that measures two channels.
const CAMPAIGN: &str = r#"[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[[device]]
name = "device"
port = "PORT"
DEVICE
[[device.channel]]
quantity = "roll"
field = 0
[[device.channel]]
quantity = "speed"
field = 1
"#;

/// A board that talks by itself, and a bus of two cells that are asked in turn and answer with
/// their number alone.
const BOARD: &str = "profile = \"cobs-board\"\nsettings = { fields = 2 }";
const CELLS: &str = "profile = \"mantracourt-dsc\"\nbaud = 115200\n\
     settings = { stations = [1, 2] }\npace = { rate_hz = 100.0, timeout_s = 0.05 }";

/// The device behind an emulated port.
fn plugged(folder: &Path, lines: &str, clock: &Arc<WallClock>) -> (DeviceConfig, EmulatedPort) {
    let port = folder.join("port").display().to_string();
    let text = CAMPAIGN.replace("PORT", &port).replace("DEVICE", lines);
    fs::write(folder.join(FILE_NAME), text).expect("the disk has room");
    let read = campaign::read(folder).unwrap_or_else(|mistakes| panic!("{mistakes:?}"));
    let config = read.live.devices[0].clone();
    // The fields never agree, so that one taken for the other shows.
    let signal = |field: usize, time_s: f64| field as f64 * 2.0 + 0.2 * time_s.sin();
    let other_end = emulator(&config.driver, &config.settings, RATE_HZ, Box::new(signal));
    let other_end = other_end.expect("the settings are good");
    let clock = Arc::clone(clock) as Arc<dyn Clock>;
    let plugged = EmulatedPort::plug_in(&config.port, other_end, config.line.byte_ns(), clock);
    (config, plugged.expect("a pseudo-terminal"))
}

/// Takes events as the loop does, between two stalls and after them.
fn follow(
    attached: &mut Attached,
    keeper: &mut Keeper,
    events: &Receiver<LinkEvent>,
    clock: &WallClock,
) -> Vec<Sample> {
    let (mut losses, mut taken) = (LinkLosses::default(), Taken::default());
    for stalls in [true, true, false] {
        let until_ns = clock.now_ns() + 400_000_000;
        while clock.now_ns() < until_ns {
            let Ok(link) = events.recv_timeout(Duration::from_millis(20)) else { continue };
            attached.take(&link, clock.now_ns() as f64 / 1e9, &mut losses, &mut taken);
            taken.records.drain(..).for_each(|record| keeper.push(record));
        }
        if stalls {
            thread::sleep(STALL);
        }
    }
    taken.samples
}

fn gaps(recording: &Path) -> Vec<Gap> {
    let mut recorded = Recorded::open(recording).expect("it is whole");
    let records = std::iter::from_fn(|| recorded.next_record().expect("it can be read"));
    let gaps = records.filter_map(|record| match record {
        Record::Gap(gap) => Some(gap),
        _ => None,
    });
    gaps.collect()
}

fn a_stalled_loop_of(lines: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let clock = Arc::new(WallClock::start_at_speed(1.0));
    let (config, _port) = plugged(folder.path(), lines, &clock);
    let recording = folder.path().join("stalled.mcap");
    let mut keeper = Keeper::start(&recording, String::new(), &clock).expect("it begins");
    let (sender, events) = sync_channel(EVENTS_WAITING);
    let outlet = Box::new(move |link| sender.try_send(link).is_ok());
    let own_clock = Arc::clone(&clock) as Arc<dyn Clock>;
    let AttachedInstrument { thread, latency_s, .. } =
        Instrument::attach(&config, own_clock, outlet).expect("a thread");
    let mut attached = Attached::new(&config, latency_s).expect("it is attached");
    let known = attached.introduction(&config, "", 0.0).expect("it can be recorded");
    for record in known {
        keeper.push(record);
    }
    let live = follow(&mut attached, &mut keeper, &events, &clock);
    drop(thread);
    let closed = keeper.close("the story is over").expect("it is kept").expect("it is recorded");
    closed.convert().expect("it is finished");

    let n_dropped = attached.status().n_dropped;
    assert!(live.len() > 100 && n_dropped > 20, "{} samples, {n_dropped} dropped", live.len());
    let gaps = gaps(&recording);
    let of_roll: Vec<&Gap> = gaps.iter().filter(|gap| gap.channel == "roll").collect();
    assert!(of_roll.len() >= 2, "{gaps:?}");
    for gap in &of_roll[..2] {
        assert!(gap.reason.contains("found no place"), "{gap:?}");
        assert!(gap.end_s - gap.start_s > 0.05, "{gap:?}");
    }
    // No reading of one field is taken for one of the other, whatever was lost between.
    let is_whole = |sample: &&Sample| (sample.value > 1.5) == (sample.quantity == Quantity::Speed);
    assert_eq!(live.iter().filter(is_whole).count(), live.len());
    let files = [(None, recording)];
    let mut player = Player::open("stalled", &files, &Columns::default()).expect("it opens");
    let mut again = Vec::new();
    while player.read(&mut again).expect("it plays") == Reading::More {}
    let bits = |samples: &[Sample]| -> Vec<_> {
        let bits = |of: &Sample| (of.quantity, of.time_s.to_bits(), of.value.to_bits());
        samples.iter().map(bits).collect()
    };
    assert!(bits(&live) == bits(&again), "{} live, {} replayed", live.len(), again.len());
}

#[test]
fn what_a_talking_board_brought_in_vain_is_counted_and_a_gap() {
    a_stalled_loop_of(BOARD);
}

#[test]
fn cells_asked_in_turn_are_not_mistaken_for_each_other_after_a_stall() {
    a_stalled_loop_of(CELLS);
}
