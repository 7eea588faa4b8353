//! Instruments of every protocol before the daemon: raw bytes give the samples again, to the bit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use devices::{Attachment, Device, InstrumentEvent, Quantity, Reading, Sample};
use replay::{Columns, Direction, LinkDecoder, Player, Record, Recorded};

use super::http::post;
use super::live_tank::{Daemon, LiveTank};

/// How long instruments are followed before their recording is wanted again.
const BEFORE: Duration = Duration::from_millis(1500);

/// A `[[device]]` with one channel.
fn device(profile: &str, quantity: &str, lines: &str) -> String {
    format!(
        "[[device]]\nname = \"{quantity} of {profile}\"\nprofile = \"{profile}\"\n\
         port = \"PORTS/{quantity}\"\nparity = \"none\"\n{lines}\n\
         [[device.channel]]\nquantity = \"{quantity}\"\nfield = 0\n\
         calibration = {{ curve = {{ gain = 1e-5 }} }}\n"
    )
}

type ByQuantity = BTreeMap<Quantity, Vec<(u64, u64)>>;

/// Times and values to the bit, channel by channel.
fn sorted(samples: impl IntoIterator<Item = Sample>) -> ByQuantity {
    let mut all = ByQuantity::new();
    for Sample { quantity, time_s, value } in samples {
        all.entry(quantity).or_default().push((time_s.to_bits(), value.to_bits()));
    }
    all
}

fn recorded_is_decoded_anew(devices: &[String], n_channels: usize) {
    let tank = LiveTank::of_devices(&devices.concat());
    let mut daemon = Daemon::start(&tank, &[]);
    daemon.wait_for("linked", n_channels);
    std::thread::sleep(Duration::from_millis(600));
    tank.port(0).unplug();
    daemon.wait_for("link lost", 1);
    tank.port(0).replug();
    daemon.wait_for("linked", n_channels + 1);
    std::thread::sleep(Duration::from_millis(600));
    let address = daemon.address();
    let act = |what: &str| {
        let wish = format!("{{\"by\": \"C. Costa\", \"what\": \"{what}\"}}");
        assert_eq!(post(&address, "/act", &[], &wish).status, 200, "{what}");
    };
    act("stop_recording");
    daemon.wait_for("session begun", 2);
    std::thread::sleep(BEFORE);
    act("start_recording");
    daemon.wait_until("it is recorded again", || tank.files("live", ".part").len() == 1);
    std::thread::sleep(Duration::from_millis(600));
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(said.matches("linked").count(), n_channels + 1, "ports stay open: {said}");
    let files = tank.files("live", ".mcap");
    assert_eq!(files.len(), 2, "{said}");
    let [_, joined_s] = [&files[0], &files[1]].map(|file| decoded_anew(file, n_channels, &said));
    assert!(joined_s > BEFORE.as_secs_f64() + 0.3, "{joined_s} s: {said}");
    are_one(&files, &said);
}

/// Two recordings hold the values, one after the other, that one would have held.
fn are_one(files: &[PathBuf], said: &str) {
    let mut decoders: BTreeMap<String, LinkDecoder> = BTreeMap::new();
    let (mut in_two, mut in_one) = (ByQuantity::new(), ByQuantity::new());
    for (index, file) in files.iter().enumerate() {
        let mut records = Recorded::open(file).expect("it is whole");
        let mut begun: Vec<String> = Vec::new();
        while let Some(record) = records.next_record().expect("it can be read") {
            match record {
                Record::Device(device) if index == 0 => {
                    let attachment = Attachment::from_text(&device.settings).expect("it is ours");
                    let decoder = LinkDecoder::new(&attachment).expect("its driver takes it");
                    decoders.insert(device.device, decoder);
                }
                Record::Sample(Sample { quantity, value, .. }) => {
                    in_two.entry(quantity).or_default().push((0, value.to_bits()));
                }
                Record::Raw(raw) if raw.direction == Direction::Begun => {
                    begun.push(raw.device.to_string());
                }
                Record::Raw(raw) if index == 0 || begun.iter().any(|of| **of == *raw.device) => {
                    let (link, mut events) = (raw.link_event().expect("no mark"), Vec::new());
                    let decoder = decoders.get_mut(&*raw.device).expect("it was attached");
                    decoder.take(&link, &mut events);
                    for event in events {
                        let InstrumentEvent::Sample(measured) = event else { continue };
                        let Sample { quantity, value, .. } = measured.sample;
                        in_one.entry(quantity).or_default().push((0, value.to_bits()));
                    }
                }
                _ => {}
            }
        }
    }
    for (quantity, values) in &in_two {
        assert!(in_one.get(quantity) == Some(values), "{quantity:?} has a seam: {said}");
    }
}

/// Samples beside the raw bytes are what these give anew; how long the recording is [s].
fn decoded_anew(file: &Path, n_channels: usize, said: &str) -> f64 {
    let mut records = Recorded::open(file).expect("it is whole");
    let records = std::iter::from_fn(|| records.next_record().expect("it can be read"));
    let live = sorted(records.filter_map(|record| match record {
        Record::Sample(sample) => Some(sample),
        _ => None,
    }));
    let files = [(None, file.to_owned())];
    let mut player = Player::open("live", &files, &Columns::default()).expect("it opens");
    let mut again = Vec::new();
    while player.read(&mut again).expect("it plays") == Reading::More {}
    let again = sorted(again);
    assert_eq!(live.len(), n_channels, "{said}");
    for (quantity, samples) in &live {
        assert!(samples.len() >= 8, "{quantity:?}: {} samples: {said}", samples.len());
        assert!(again.get(quantity) == Some(samples), "{quantity:?} differs: {said}");
    }
    let length_s = |samples: &Vec<(u64, u64)>| {
        let time_s = |at: usize| f64::from_bits(samples[at].0);
        time_s(samples.len() - 1) - time_s(0)
    };
    live.values().map(length_s).fold(f64::INFINITY, f64::min)
}

#[test]
fn load_cells_of_two_makers_and_a_bus_of_modules() {
    let devices = [
        device("mantracourt-dsc", "roll", "settings = { stations = [1] }"),
        device("hbm-ad104-binary", "moment", "settings = { checked = true }"),
        device("adam-4017", "speed", "pace = { rate_hz = 20.0, timeout_s = 0.1 }"),
    ];
    recorded_is_decoded_anew(&devices, 3);
}

#[test]
fn binary_buses_registers_and_text() {
    let registers = "settings = { fields = [\
         { function = 4, address = 0, type = \"float32\", order = \"CDAB\" }] }";
    let devices = [
        device("mantrabus-dsc", "roll", "settings = { stations = [1], command = 40 }"),
        device("hbm-ad104", "moment", "baud = 38400\nsettings = { stations = [1] }"),
        device("modbus-transmitter", "speed", registers),
    ];
    recorded_is_decoded_anew(&devices, 3);
}

#[test]
fn own_electronics_in_binary_and_text() {
    let devices = [
        device("cobs-board", "roll", "settings = { fields = 1 }"),
        device("arduino-text", "speed", "settings = { pattern = \"$A,{sequence},{0}*{xor}\" }"),
    ];
    recorded_is_decoded_anew(&devices, 2);
}
