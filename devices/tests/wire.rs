//! A driver's session and its emulator joined without port or clock: thousands of cycles a second.

use devices::driver::{Decoded, FieldValue, Purpose, Session, driver};
use devices::emulator::{Emulator, Faults, Signal, emulator};
use devices::port::{Line, Parity};
use devices::profile::PaceSettings;

/// The settings that the wire stories go through: every driver, in its different forms.
pub(crate) const FORMS: [(&str, &str); 22] = [
    ("text-line", "pattern = \"$RD,{sequence},{time_us},{0},{1}*{xor}\""),
    ("text-line", "pattern = \"{time_s} {0};{1} {sum}\"\ndecimal_comma = true"),
    ("text-line", "pattern = \"S{0}\"\nrequest = \"SX\\r\\n\""),
    ("mantracourt", ""),
    ("mantracourt", "stations = [1, 14]\nsnapshot = true\nstatus = true"),
    ("mantrabus", "stations = [20, 21]\ncommand = 40"),
    ("dcon", "modules = [{ address = 1, channels = 4 }]"),
    ("dcon", "modules = [{ address = 1 }, { address = 2 }]\nchecksum = true"),
    ("dcon", "modules = [{ address = 1 }, { address = 2 }]\nsynchronised = true"),
    ("dcon", "modules = [{ address = 1, channels = 2 }]\nhexadecimal = true\nchecksum = true"),
    ("modbus-rtu", "[[fields]]\nfunction = 4\naddress = 0\ntype = \"float32\"\norder = \"CDAB\""),
    (
        "modbus-rtu",
        "[[fields]]\nfunction = 3\naddress = 5\ntype = \"int16\"\n\
         [[fields]]\nstation = 2\nfunction = 4\naddress = 9\ntype = \"int32\"\norder = \"ABCD\"",
    ),
    ("hbm-ascii", ""),
    ("hbm-ascii", "stations = [1, 2, 31]"),
    ("hbm-ascii", "continuous = true"),
    ("hbm-binary", "format = 8\nchecked = true"),
    ("hbm-binary", "format = 2"),
    ("hbm-binary", "format = 12\nchecked = true"),
    ("cobs", "fields = 3\nidentify = true"),
    ("text-line", "pattern = \"S{0}\"\nidentify = \"ID?\\n\"\nidentity_line = \"ID {name}\""),
    ("mantrabus", "command = 40\nversion_command = 5\nset_up = [{ command = 9, value = 0.5 }]"),
    (
        "modbus-rtu",
        "identify = { function = 17 }\nset_up = [{ station = 1, address = 9, registers = [7] }]\n\
         [[fields]]\nfunction = 3\naddress = 5\ntype = \"int16\"",
    ),
];

/// A session in conversation.
pub(crate) struct Wire {
    pub(crate) session: Session,
    emulator: Box<dyn Emulator>,
    pub(crate) faults: Faults,
    pub(crate) now_ns: u64,
    /// The last turn asked for readings, and the whole answer came.
    pub(crate) is_answered: bool,
    /// Everything decoded since it was last taken.
    pub(crate) decoded: Vec<Decoded>,
}

pub(crate) fn session(name: &str, settings: &str) -> Session {
    let line = Line { baud: 115_200, data_bits: 8, parity: Parity::None, stop_bits: 1 };
    let table = settings.parse().expect("the settings are good");
    let protocol = (driver(name).expect("the settings are good").open)(&table)
        .unwrap_or_else(|error| panic!("{error}"));
    Session::new(protocol, PaceSettings::default().pace(&line))
}

impl Wire {
    pub(crate) fn new(name: &str, settings: &str, signal: Signal) -> Self {
        Self::at_rate(name, settings, 200.0, signal)
    }

    /// With an instrument that converts so often.
    pub(crate) fn at_rate(name: &str, settings: &str, rate_hz: f64, signal: Signal) -> Self {
        let table = settings.parse().expect("the settings are good");
        let emulator = emulator(name, &table, rate_hz, signal).expect("the settings are good");
        let mut session = session(name, settings);
        session.open(0);
        let faults = Faults::default();
        Self { session, emulator, faults, now_ns: 0, is_answered: false, decoded: Vec::new() }
    }

    /// One turn: what the host says, and what comes back through `spoil`.
    pub(crate) fn turn(&mut self, spoil: impl FnOnce(&mut Vec<u8>)) {
        let mut sent = Vec::new();
        self.session.poll(self.now_ns, &mut sent, &mut self.decoded);
        let now_s = self.now_ns as f64 * 1e-9;
        let mut answer = Vec::new();
        if !sent.is_empty() {
            self.emulator.receive(&sent, now_s, &mut self.faults, &mut answer);
        }
        self.emulator.tick(now_s, &mut self.faults, &mut answer);
        let whole = answer.clone();
        spoil(&mut answer);
        let cycle = self.session.protocol().cycle();
        let mut reads = cycle.iter().filter(|request| request.purpose == Purpose::Read);
        let is_read = reads.any(|request| request.bytes == sent);
        self.is_answered = is_read && !whole.is_empty() && whole == answer;
        self.now_ns += 2_000_000;
        if !answer.is_empty() {
            self.session.receive(&answer, self.now_ns, &mut self.decoded);
        }
        let wake_ns = self.session.wake_ns().unwrap_or(0);
        self.now_ns = (self.now_ns + 3_000_000).max(wake_ns.min(self.now_ns + 500_000_000));
    }

    /// Readings decoded since they were last taken.
    pub(crate) fn take_readings(&mut self) -> Vec<FieldValue> {
        let decoded = std::mem::take(&mut self.decoded);
        let values = decoded.into_iter().filter_map(|what| match what {
            Decoded::Values { values, .. } => Some(values),
            _ => None,
        });
        values.flatten().collect()
    }
}
