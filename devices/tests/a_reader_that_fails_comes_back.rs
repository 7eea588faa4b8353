//! A fault in a driver takes its link away for a moment, and nothing else.

use std::sync::Arc;
use std::time::Duration;

use devices::clock::{Clock, WallClock};
use devices::driver::{Content, Found, Protocol, Request, Session};
use devices::emulator::{EmulatedPort, emulator};
use devices::port::{LinkEvent, LinkOptions, LinkReader};

use crate::bench::{channels, device, swing};

/// Lines that end with CR LF; fails at the one that it was told to fail at.
struct Fragile {
    n_good: u32,
}

impl Protocol for Fragile {
    fn fields(&self) -> Vec<String> {
        Vec::new()
    }

    fn opening(&self) -> Vec<Request> {
        Vec::new()
    }

    fn cycle(&self) -> Vec<Request> {
        Vec::new()
    }

    fn decode(&mut self, bytes: &[u8], _asked: Option<&Request>) -> Found {
        let Some(end) = bytes.iter().position(|byte| *byte == b'\n') else { return Found::Part };
        self.n_good = self.n_good.checked_sub(1).expect("one line too many");
        Found::Frame { n_bytes: end + 1, content: Content::Accepted }
    }
}

#[test]
fn a_driver_that_panics_is_told_as_a_lost_link_and_read_again() {
    let settings = "[settings]\npattern = \"$A,{sequence},{0}*{xor}\"\n";
    let (_folder, config) = device("arduino-text", &format!("{settings}{}", channels(1)));
    let board = emulator(&config.driver, &config.settings, 100.0, Box::new(swing));
    let clock: Arc<dyn Clock> = Arc::new(WallClock::start());
    let (path, byte_ns) = (&config.port, config.line.byte_ns());
    let board = board.expect("the settings are good");
    let _port = EmulatedPort::plug_in(path, board, byte_ns, Arc::clone(&clock)).expect("a port");
    let options = LinkOptions { path: path.clone(), line: config.line, realtime: false };
    let session = Session::new(Box::new(Fragile { n_good: 20 }), config.pace.pace(&config.line));
    let reader = LinkReader::start(options, session, clock).expect("a thread");
    let mut events = Vec::new();
    let n_opened = |events: &[LinkEvent]| {
        events.iter().filter(|event| matches!(event, LinkEvent::Opened { .. })).count()
    };
    // Every opening after the first follows a failure, since no line is good any more.
    while n_opened(&events) < 3 {
        let event = reader.next(Duration::from_secs(10));
        events.push(event.unwrap_or_else(|| panic!("the thread is dead: {events:?}")));
    }
    let lost = events.iter().find_map(|event| match event {
        LinkEvent::Lost { seen, .. } => Some(seen.as_str()),
        _ => None,
    });
    assert_eq!(lost, Some("reading it failed: one line too many"), "{events:?}");
    let n_read = events.iter().filter(|event| matches!(event, LinkEvent::Received { .. })).count();
    assert!(n_read >= 10, "what came before was kept: {events:?}");
}
