//! Who hangs on a port is asked where the protocol has a way, and told plainly where it has none.

use std::sync::Arc;

use devices::InstrumentError;
use devices::clock::WallClock;
use devices::driver::driver;
use devices::emulator::{EmulatedPort, emulator};
use devices::probe::probe;
use devices::setup::DeviceSetup;

use crate::bench::{bench, channels, device, swing};

const MODBUS: &str = "{ function = 3, address = 0, type = \"int16\" }";

/// Each driver with settings by which it asks, and part of what its emulator says.
fn askers() -> [(&'static str, String, &'static str); 8] {
    [
        (
            "arduino-text",
            "{ pattern = \"{0}\", identify = \"ID?\\n\", identity_line = \"ID {name}\" }"
                .to_owned(),
            "emulated board",
        ),
        ("mantracourt-dsc", "{ set_up = { FFST = 0.0 } }".to_owned(), "Mantracourt version 3.1"),
        (
            "mantrabus-dsc",
            "{ command = 40, version_command = 5, set_up = [{ command = 9, value = 0.0 }] }"
                .to_owned(),
            "Mantracourt version 3.1",
        ),
        ("adam-4017", "{}".to_owned(), "4017"),
        (
            "modbus-transmitter",
            format!(
                "{{ fields = [{MODBUS}], identify = {{ function = 17 }}, \
                 set_up = [{{ station = 1, address = 100, registers = [0, 0] }}] }}"
            ),
            "emulated transmitter",
        ),
        ("hbm-ad104", "{}".to_owned(), "AD104"),
        ("hbm-ad104-binary", "{}".to_owned(), "AD104"),
        ("cobs-board", "{}".to_owned(), "emulated board"),
    ]
}

#[test]
fn every_driver_asks_who_it_is_where_its_settings_say_how() {
    for (profile, settings, identity) in askers() {
        let lines = format!("identity = \"{identity}\"\nsettings = {settings}\n{}", channels(1));
        let mut bench = bench(profile, &lines, 200.0);
        bench.listen_until(|bench| bench.n_samples() >= 20);
        bench.listen_for(0.1);
        let is_said = bench.events.iter().any(|event| {
            matches!(event, devices::InstrumentEvent::Identity(text) if text.contains(identity))
        });
        assert!(is_said, "{profile}: {:?}", bench.events);
        assert_eq!(bench.troubles(), Vec::<String>::new(), "{profile}");
    }
}

#[test]
fn an_instrument_that_does_not_say_who_it_is_is_told_with_the_question() {
    let asked = "settings = { identify = \"ID?\\n\", identity_line = \"ID {name}\" }";
    let lines = format!("identity = \"board 2\"\n{asked}\n{}", channels(1));
    let (_folder, config) = device("arduino-text", &lines);
    // Its readings are good, so that nothing but the silence on that question can be seen.
    let settings = "pattern = \"$RD,{sequence},{time_us},{0},{1}*{xor}\"".parse().unwrap();
    let board = emulator("text-line", &settings, 100.0, Box::new(swing)).unwrap();
    let clock: Arc<dyn devices::clock::Clock> = Arc::new(WallClock::start());
    let _port =
        EmulatedPort::plug_in(&config.port, board, config.line.byte_ns(), Arc::clone(&clock))
            .unwrap();
    let report = probe(&config, 2_000_000_000, &clock).unwrap();
    let [trouble] = &report.troubles[..] else { panic!("{:?}", report.troubles) };
    let told = trouble.to_string();
    assert!(told.starts_with("device \"bench\": port \""), "{told}");
    let seen = "usb-Emulated-if00-port0\" brings readings but does not say who it is, \
                asked \"ID?\\n\", expected is \"board 2\"";
    assert!(told.contains(seen), "{told}");
    let hint = trouble.hint().expect("there is one");
    assert!(hint.starts_with("another instrument may hang on this port"), "{hint}");
    assert!(report.asks_who && report.identity.is_none(), "{report:?}");
}

#[test]
fn an_identity_that_nobody_can_ask_for_is_refused_with_the_way_to_ask() {
    let cannot = [
        ("arduino-text", "{}".to_owned(), "give settings.identify, such as"),
        ("mantrabus-dsc", "{ command = 40 }".to_owned(), "give settings.version_command"),
        ("modbus-transmitter", format!("{{ fields = [{MODBUS}] }}"), "give settings.identify: {"),
        ("cobs-board", "{ identify = false }".to_owned(), "give settings.identify = true"),
    ];
    for (profile, settings, way) in cannot {
        let text = |identity: &str| {
            format!(
                "name = \"bench\"\nprofile = \"{profile}\"\nport = \"/dev/x\"\n{identity}\n\
                 settings = {settings}\n{}",
                channels(1)
            )
        };
        let resolve = |identity: &str| {
            let setup: DeviceSetup = toml::from_str(&text(identity)).unwrap();
            setup.resolve()
        };
        assert!(resolve("").is_ok(), "{profile}");
        let error = resolve("identity = \"board 2\"").unwrap_err();
        let InstrumentError::CannotAsk { driver: name, .. } = &error else { panic!("{error}") };
        assert!(driver(name).is_some());
        let told = error.to_string();
        assert!(
            told.starts_with("device \"bench\": identity is \"board 2\", but driver"),
            "{told}"
        );
        let hint = error.hint().expect("there is one");
        assert!(hint.starts_with(way) && hint.ends_with("or drop identity"), "{hint}");
    }
}
