//! Any bytes, in any pieces, at any times, into every driver: `cargo +nightly fuzz run session`.
#![no_main]

use devices::driver::{FRAME_BYTES_MAX, Pace, Session, driver};
use libfuzzer_sys::fuzz_target;

const FORMS: [(&str, &str); 12] = [
    ("text-line", "pattern = \"$RD,{sequence},{time_us},{0},{1}*{xor}\""),
    ("text-line", "pattern = \"S{0}\"\nrequest = \"SX\\r\\n\""),
    ("mantracourt", "stations = [1, 14]\nsnapshot = true\nstatus = true"),
    ("mantrabus", "stations = [20, 21]\ncommand = 40"),
    ("dcon", "modules = [{ address = 1, channels = 4 }]"),
    ("dcon", "modules = [{ address = 1 }, { address = 2 }]\nchecksum = true\nsynchronised = true"),
    ("modbus-rtu", "[[fields]]\nfunction = 4\naddress = 0\ntype = \"float32\"\norder = \"CDAB\""),
    ("hbm-ascii", "stations = [1, 2, 31]"),
    ("hbm-ascii", "continuous = true"),
    ("hbm-binary", "format = 8\nchecked = true"),
    ("hbm-binary", "format = 2"),
    ("cobs", "fields = 3\nidentify = true"),
];

const PACE: Pace =
    Pace { period_ns: 0, timeout_ns: 50_000_000, gap_ns: 1_000_000, byte_ns: 86_805, boot_ns: 0 };

fuzz_target!(|input: (u8, Vec<(u16, Vec<u8>)>)| {
    let (form, pieces) = input;
    let (name, settings) = FORMS[usize::from(form) % FORMS.len()];
    let table = settings.parse().expect("these settings are TOML");
    let protocol = (driver(name).expect("it exists").open)(&table).expect("they are good");
    let mut session = Session::new(protocol, PACE);
    session.open(0);
    let (mut now_ns, mut sent, mut decoded) = (0, Vec::new(), Vec::new());
    for (step, bytes) in pieces {
        now_ns += u64::from(step) * 10_000;
        session.poll(now_ns, &mut sent, &mut decoded);
        session.receive(&bytes, now_ns, &mut decoded);
        assert!(session.n_held() <= FRAME_BYTES_MAX, "{name} holds {}", session.n_held());
        decoded.clear();
        sent.clear();
    }
});
