//! Two instruments on one address of a bus: what comes of their answers, and that it is told.

use std::sync::Arc;

use devices::clock::{Clock, WallClock};
use devices::emulator::{EmulatedPort, Emulator, Faults, emulator};
use devices::probe::{ProbeReport, probe};
use devices::setup::DeviceConfig;

use crate::bench::{channels, device};

/// Two instruments of one kind that both answer.
struct Twins {
    one: Box<dyn Emulator>,
    other: Box<dyn Emulator>,
    /// Where they differ, the second answer begins so many bytes after the first; none after it.
    late_bytes: Option<usize>,
}

impl Twins {
    fn of(config: &DeviceConfig, raws: [f64; 2], late_bytes: Option<usize>) -> Box<dyn Emulator> {
        let [one, other] = raws.map(|raw| {
            let signal = Box::new(move |_, _| raw);
            emulator(&config.driver, &config.settings, 100.0, signal).expect("good settings")
        });
        Box::new(Self { one, other, late_bytes })
    }
}

impl Emulator for Twins {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        let (mut first, mut second) = (Vec::new(), Vec::new());
        self.one.receive(bytes, now_s, faults, &mut first);
        self.other.receive(bytes, now_s, faults, &mut second);
        if second.is_empty() || (first == second && self.late_bytes.is_some()) {
            return out.append(&mut first);
        }
        let at = self.late_bytes.unwrap_or(first.len());
        first.resize(first.len().max(at + second.len()), 0xFF);
        // Of two drivers on one pair of wires the one that pulls a bit down is heard.
        first[at..].iter_mut().zip(second).for_each(|(byte, other)| *byte &= other);
        out.append(&mut first);
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, _now_s: f64) {}
}

fn asked(config: &DeviceConfig, twins: Box<dyn Emulator>) -> ProbeReport {
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    let byte_ns = config.line.byte_ns();
    let _port = EmulatedPort::plug_in(&config.port, twins, byte_ns, Arc::clone(&clock))
        .expect("a pseudo-terminal");
    probe(config, 2_000_000_000, &clock).expect("the settings are good")
}

fn told(report: &ProbeReport) -> String {
    let told = |trouble: &devices::InstrumentError| {
        format!("{trouble}\nhint: {}\n", trouble.hint().unwrap_or_default())
    };
    report.troubles.iter().map(told).collect()
}

#[test]
fn answers_one_after_the_other_are_told_as_unasked() {
    let (_folder, config) = device("adam-4017", &channels(1));
    let report = asked(&config, Twins::of(&config, [1.5, 1.5], None));
    let told = told(&report);
    assert!(told.starts_with("device \"bench\": port \""), "{told}");
    assert!(
        told.contains("usb-Emulated-if00-port0\" brings answers that nobody asked for"),
        "{told}"
    );
    assert!(told.contains("hint: two instruments may have one address"), "{told}");
}

#[test]
fn answers_that_garble_each_other_are_told_with_their_address() {
    let modbus =
        "settings = { fields = [{ station = 7, function = 3, address = 0, type = \"int16\" }] }\n";
    let cases = [
        ("adam-4017", "settings = { modules = [{ address = 7, channel = 0 }] }\n", "\"#070\\r\""),
        ("mantrabus-dsc", "settings = { stations = [7], command = 40 }\n", "FE 07 A8"),
        ("mantracourt-dscusb", "settings = { stations = [7], status = false }\n", "!007:SYS?"),
        ("modbus-transmitter", modbus, "07 03 00 00"),
    ];
    for (profile, settings, request) in cases {
        let pace = "pace = { timeout_s = 0.06 }\n";
        let (_folder, config) = device(profile, &format!("{pace}{settings}{}", channels(1)));
        let report = asked(&config, Twins::of(&config, [1.5, 700.25], Some(1)));
        let told = told(&report);
        let seen = "usb-Emulated-if00-port0\" brings damaged answers of address 7: ";
        assert!(told.contains(seen), "{profile}: {told} {report:?}");
        assert!(told.contains(request), "{profile}: {told}");
        assert!(told.contains("hint: two instruments may have this address"), "{profile}: {told}");
        assert_eq!(report.troubles.len(), 1, "{profile}: {told}");
    }
}

/// An instrument on a line that spoils every fourth answer.
struct Noisy {
    own: Box<dyn Emulator>,
    n_answers: usize,
}

impl Emulator for Noisy {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        self.own.receive(bytes, now_s, faults, out);
        if !out.is_empty() {
            self.n_answers += 1;
            if self.n_answers.is_multiple_of(4) {
                out[1] ^= 0x80;
            }
        }
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, _now_s: f64) {}
}

#[test]
fn a_line_that_damages_an_answer_now_and_then_is_not_taken_for_two() {
    let (_folder, config) =
        device("adam-4017", &format!("pace = {{ timeout_s = 0.02 }}\n{}", channels(1)));
    let own = emulator(&config.driver, &config.settings, 100.0, Box::new(|_, _| 1.5)).unwrap();
    let report = asked(&config, Box::new(Noisy { own, n_answers: 0 }));
    assert!(report.channels[0].counts.damaged >= 7, "{report:?}");
    assert!(report.troubles.is_empty(), "{}", told(&report));
}
