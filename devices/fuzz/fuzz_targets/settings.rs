//! Any settings into every driver, and then a few bytes: `cargo +nightly fuzz run settings`.
#![no_main]

use devices::driver::DRIVERS;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (u8, &str, Vec<u8>)| {
    let (driver, text, bytes) = input;
    let Ok(table) = text.parse() else { return };
    let entry = &DRIVERS[usize::from(driver) % DRIVERS.len()];
    let Ok(mut protocol) = (entry.open)(&table) else { return };
    let requests: Vec<_> = protocol.opening().into_iter().chain(protocol.cycle()).collect();
    if !bytes.is_empty() {
        protocol.decode(&bytes, None);
        for request in &requests {
            protocol.decode(&bytes, Some(request));
        }
    }
});
