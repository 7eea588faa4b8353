//! Whatever is plugged or written wrongly is told with device, port, what was seen, and a hint.

use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, Fault, emulator};
use devices::probe::probe;
use devices::setup::{self, DeviceSetup};
use devices::{Instrument, InstrumentError, InstrumentEvent};

use crate::bench::{Bench, bench, channels, device, swing};

fn setups(text: &str) -> Vec<DeviceSetup> {
    let mut table: toml::Table = text.parse().expect("the text is TOML");
    table
        .remove("device")
        .expect("it has devices")
        .try_into()
        .unwrap_or_else(|error| panic!("{error}"))
}

/// The mistakes of a campaign's devices, each with its hint.
fn mistakes(text: &str) -> Vec<String> {
    let (_, mistakes) = setup::check(&setups(text));
    mistakes.iter().map(told).collect()
}

fn told(error: &InstrumentError) -> String {
    match error.hint() {
        Some(hint) => format!("{error}\nhint: {hint}"),
        None => error.to_string(),
    }
}

/// The first trouble that a live device brings.
fn first_trouble(config: &setup::DeviceConfig) -> String {
    let mut instrument =
        Instrument::start(config, Arc::new(WallClock::start())).expect("the settings are good");
    let mut events = Vec::new();
    for _ in 0..400 {
        instrument.next(std::time::Duration::from_millis(20), &mut events);
        for event in events.drain(..) {
            if let InstrumentEvent::Trouble(error) = event {
                return told(&error);
            }
        }
    }
    panic!("no trouble was told");
}

/// Device and port stand in a message, the port by its stable name.
fn names_device_and_port(told: &str) -> bool {
    told.starts_with("device \"bench\": ") && told.contains("usb-Emulated-if00-port0\"")
}

/// Plugs the emulator of a driver in where a device listens.
fn plug_in(config: &setup::DeviceConfig, driver: &str, settings: &str) -> EmulatedPort {
    let emulator =
        emulator(driver, &settings.parse().expect("the settings are good"), 100.0, Box::new(swing))
            .expect("the settings are good");
    let clock = Arc::new(WallClock::start());
    EmulatedPort::plug_in(&config.port, emulator, config.line.byte_ns(), clock)
        .expect("a pseudo-terminal")
}

#[test]
fn a_missing_port_is_told() {
    let (_folder, config) = device("cobs-board", &channels(1));
    let told = first_trouble(&config);
    assert!(names_device_and_port(&told), "{told}");
    assert!(told.contains("usb-Emulated-if00-port0\" does not exist\nhint: "), "{told}");
}

#[test]
fn a_busy_port_is_told() {
    let bench = bench("cobs-board", &channels(1), 100.0);
    let mut config = bench.config.clone();
    config.name = "second".to_owned();
    std::thread::sleep(std::time::Duration::from_millis(200));
    let told = first_trouble(&config);
    assert!(told.starts_with("device \"second\": port \""), "{told}");
    assert!(told.contains("is in use by another program\nhint: close the other"), "{told}");
}

#[test]
fn a_port_that_this_user_may_not_open_is_told() {
    const NAME: &str = "a_wrong_setup_is_told_with_its_remedy::\
                        a_port_that_this_user_may_not_open_is_told";
    const NOBODY: u32 = 65_534;
    if let Some(port) = std::env::var_os("ROLLTANK_FORBIDDEN") {
        let (_folder, mut config) = device("cobs-board", &channels(1));
        config.port = port.into();
        println!("{}", first_trouble(&config));
        return;
    }
    // The superuser may open anything, so nobody in particular tries.
    let folder = tempfile::tempdir().unwrap();
    let open_to_all = |path: &Path, mode| {
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
    };
    open_to_all(folder.path(), 0o755);
    let port = folder.path().join("port");
    std::fs::write(&port, "").unwrap();
    open_to_all(&port, 0o600);
    let program = folder.path().join("stories");
    std::fs::copy(std::env::current_exe().unwrap(), &program).unwrap();
    let mut command = Command::new(&program);
    command.args(["--exact", NAME, "--nocapture"]).env("ROLLTANK_FORBIDDEN", &port);
    let is_root = std::fs::read_to_string("/proc/self/status").unwrap().contains("Uid:\t0");
    if is_root {
        command.uid(NOBODY).gid(NOBODY).current_dir("/");
    } else {
        open_to_all(&port, 0o000);
    }
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(told.contains("device \"bench\": port \""), "{told}");
    assert!(told.contains("may not be opened by this user\nhint: add the user to"), "{told}");
}

#[test]
fn a_file_that_is_no_port_is_told() {
    let (_folder, mut config) = device("cobs-board", &channels(1));
    config.port = "/dev/null".into();
    let told = first_trouble(&config);
    assert!(told.contains("\"/dev/null\" is no serial port\nhint: give a port"), "{told}");
}

#[test]
fn a_parity_that_the_port_refuses_is_told() {
    let (_folder, mut config) = device("hbm-ad104", &channels(1));
    config.line.parity = devices::port::Parity::Even;
    let _port = plug_in(&config, "hbm-ascii", "");
    let told = first_trouble(&config);
    assert!(names_device_and_port(&told), "{told}");
    assert!(told.contains("refuses parity \"Even\" and stays at \"None\"\nhint: "), "{told}");
}

#[test]
fn a_talker_at_another_speed_is_told_as_garbage() {
    let (_folder, config) = device("arduino-text", &channels(1));
    let port =
        plug_in(&config, "text-line", "pattern = \"$RD,{sequence},{time_us},{0},{1}*{xor}\"");
    port.fault(Fault::Baud(57_600));
    let told = first_trouble(&config);
    assert!(names_device_and_port(&told), "{told}");
    assert!(told.contains("brings garbage at 115200 8N1"), "{told}");
    assert!(told.contains("bytes without one good frame, such as "), "{told}");
    assert!(told.contains("hint: check baud and parity"), "{told}");
}

#[test]
fn an_instrument_that_is_asked_at_another_speed_is_told_as_silent() {
    let (_folder, config) = device("adam-4017", &channels(1));
    let port = plug_in(&config, "dcon", "modules = [{ address = 1 }]");
    port.fault(Fault::Baud(19_200));
    let told = first_trouble(&config);
    assert!(names_device_and_port(&told), "{told}");
    assert!(told.contains("\" at 9600 8N1, asked \"#010\\r\""), "{told}");
    assert!(told.contains("nothing comes from port"), "{told}");
    assert!(told.contains("hint: check power, address, baud"), "{told}");
    // Set to the port's speed it is the instrument that was meant.
    port.fault(Fault::Baud(9600));
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    let report = probe(&config, 1_000_000_000, &clock).expect("the settings are good");
    assert!(report.troubles.is_empty() && report.channels[0].last.is_some(), "{report:?}");
}

#[test]
fn another_instrument_on_the_port_is_told() {
    let lines = format!("identity = \"4018\"\n{}", channels(1));
    let mut bench = bench("adam-4017", &lines, 100.0);
    let is_told = |bench: &Bench| bench.trouble().is_some();
    bench.listen_until(is_told);
    let told = told(bench.trouble().expect("it was told"));
    assert!(names_device_and_port(&told), "{told}");
    let seen =
        "answers \"4017\", expected is \"4018\"\nhint: another instrument hangs on this port";
    assert!(told.contains(seen), "{told}");
}

#[test]
fn an_address_where_nobody_is_is_told() {
    let lines = format!("[settings]\nmodules = [{{ address = 7 }}]\n{}", channels(1));
    let (_folder, config) = device("adam-4017", &lines);
    let _port = plug_in(&config, "dcon", "modules = [{ address = 1 }]");
    let told = first_trouble(&config);
    assert!(names_device_and_port(&told), "{told}");
    assert!(told.contains("nothing comes from port"), "{told}");
    assert!(told.contains("asked \"#07\\r\"\nhint: check power, address"), "{told}");
}

#[test]
fn one_silent_station_among_others_is_told() {
    let lines = format!("[settings]\nstations = [1, 14]\n{}", channels(2));
    let (_folder, config) = device("mantracourt-dsc", &lines);
    let _port = plug_in(&config, "mantracourt", "stations = [1]\nsnapshot = true");
    let told = first_trouble(&config);
    assert!(told.contains("nothing comes from port"), "{told}");
    assert!(told.contains("asked \"!014:"), "{told}");
}

#[test]
fn every_silence_is_told_once() {
    let mut bench = bench("cobs-board", &channels(2), 100.0);
    for n_silences in 1..=2 {
        bench.port.fault(Fault::Mute(false));
        let n_samples = bench.n_samples();
        bench.listen_until(|bench| bench.n_samples() > n_samples + 10);
        bench.port.fault(Fault::Mute(true));
        bench.listen_for(1.6);
        assert_eq!(bench.troubles().len(), n_silences, "{:?}", bench.troubles());
    }
}

#[test]
fn a_refused_request_is_told() {
    let field = "[[settings.fields]]\nfunction = 3\naddress = 40\ntype = \"int16\"\n";
    let (_folder, config) = device("modbus-transmitter", &format!("{field}{}", channels(1)));
    let other = "[[fields]]\nfunction = 3\naddress = 0\ntype = \"int16\"";
    let _port = plug_in(&config, "modbus-rtu", other);
    let told = first_trouble(&config);
    assert!(told.contains("refuses \"01 03 00 28 00 01"), "{told}");
    assert!(told.contains("\"exception 2\"\nhint: "), "{told}");
}

#[test]
fn an_instrument_that_says_nothing_is_told_once() {
    let mut bench = bench("cobs-board", &channels(1), 100.0);
    bench.port.fault(Fault::Mute(true));
    bench.listen_for(2.5);
    let told = bench.troubles();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("nothing comes from port"), "{told:?}");
}

#[test]
fn every_mistake_of_a_campaign_is_told_at_once() {
    let mistakes = mistakes(
        r#"
        [[device]]
        name = "pot"
        profile = "adam-4017"
        port = "/dev/serial/by-id/a"
        channel = [{ quantity = "roll", field = 0 }]
        [[device]]
        name = "cell"
        profile = "mantracourt-dsc"
        port = "/dev/serial/by-id/a"
        settings = { stations = [1, 2] }
        channel = [{ quantity = "force", field = 2 }]
        [[device]]
        name = "speed"
        profile = "cobs-borad"
        port = "/dev/serial/by-id/c"
        [[device]]
        name = "encoder"
        profile = "cobs-board"
        port = "/dev/serial/by-id/a"
        channel = [{ quantity = "roll", field = 1 }]
        [[device]]
        name = "bus"
        profile = "adam-4017"
        port = "/dev/serial/by-id/a"
        settings = { modules = [{ address = 1 }, { address = 2 }] }
        channel = [{ quantity = "force", field = 1, calibration = { curve = { gain = 0.5 } } }]
        [[device]]
        name = "twice"
        profile = "adam-4017"
        port = "/dev/serial/by-id/d"
        settings = { modules = [{ address = 3 }, { address = 3 }] }
        channel = [{ quantity = "speed", field = 1 }]
        [[device]]
        name = "flat"
        profile = "cobs-board"
        port = "/dev/serial/by-id/e"
        channel = [{ quantity = "speed", field = 1, calibration = { curve = { gain = 0.0 } } }]
        "#,
    );
    let all = mistakes.join("\n");
    let expected = [
        "\"cell\": force is to come from field 2, but the fields are 0 (001:SYS), 1 (002:SYS)",
        "no profile is called \"cobs-borad\"\nhint: known are adam-4017, arduino-text",
        "roll is mapped twice: by device \"pot\" from field 0 (01.0) of port \
         \"/dev/serial/by-id/a\" and by device \"encoder\" from field 1 (value 1) of port \
         \"/dev/serial/by-id/a\"\nhint: keep one [[device.channel]] with quantity = \"roll\"",
        "devices \"pot\" and \"encoder\" are both on port \"/dev/serial/by-id/a\"\nhint: ",
        "devices \"pot\" and \"bus\" both have address 1 on port \"/dev/serial/by-id/a\"",
        "devices \"twice\" and \"twice\" both have address 3 on port \"/dev/serial/by-id/d\"",
        "device \"flat\": speed: calibration has the number 0",
    ];
    for part in expected {
        assert!(all.contains(part), "missing: {part}\nin:\n{all}");
    }
}

#[test]
fn wrong_settings_are_told_with_device_and_driver() {
    let mistakes = mistakes(
        "[[device]]\nname = \"pot\"\nprofile = \"adam-4017\"\nport = \"/dev/x\"\n\
         settings = { modules = [{ adress = 1 }] }",
    );
    assert!(mistakes[0].contains("device \"pot\": settings of driver \"dcon\":"), "{mistakes:?}");
    assert!(mistakes[0].contains("adress"), "{mistakes:?}");
}
