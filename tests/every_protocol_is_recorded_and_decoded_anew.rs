//! Instruments of every protocol before the daemon: raw bytes give the samples again, to the bit.

use std::collections::BTreeMap;
use std::time::Duration;

use devices::{Device, Quantity, Reading, Sample};
use replay::{Columns, Player, Record, Recorded};

use super::live_tank::{Daemon, LiveTank};

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
    let (status, said) = daemon.terminate();
    assert_eq!(status.code(), Some(0), "{said}");
    let files = tank.files("live", ".mcap");
    let mut records = Recorded::open(&files[0]).expect("it is whole");
    let records = std::iter::from_fn(|| records.next_record().expect("it can be read"));
    let live = sorted(records.filter_map(|record| match record {
        Record::Sample(sample) => Some(sample),
        _ => None,
    }));
    let files = [(None, files[0].clone())];
    let mut player = Player::open("live", &files, &Columns::default()).expect("it opens");
    let mut again = Vec::new();
    while player.read(&mut again).expect("it plays") == Reading::More {}
    let again = sorted(again);
    assert_eq!(live.len(), n_channels, "{said}");
    for (quantity, samples) in &live {
        assert!(samples.len() >= 8, "{quantity:?}: {} samples: {said}", samples.len());
        assert!(again.get(quantity) == Some(samples), "{quantity:?} differs: {said}");
    }
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
