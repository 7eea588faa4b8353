//! Answers that come late, twice or never: none passes for the answer to another request.

use devices::driver::{Decoded, Session, Taken};

use crate::wire::session;

const MS: u64 = 1_000_000;

/// A digitiser whose answers carry neither address nor check: only the time says whose they are.
fn digitiser() -> Session {
    let mut session = session("mantracourt", "");
    session.open(0);
    let (mut sent, mut decoded) = (Vec::new(), Vec::new());
    session.poll(0, &mut sent, &mut decoded);
    assert_eq!(sent, b"!001:VER?\r");
    session.receive(b"+00769.\r", 5 * MS, &mut decoded);
    assert_eq!(decoded, [Decoded::Identity("Mantracourt version 3.1".to_owned())]);
    session
}

/// What is sent at that time.
fn sent(session: &mut Session, now_ns: u64, decoded: &mut Vec<Decoded>) -> Vec<u8> {
    let mut sent = Vec::new();
    session.poll(now_ns, &mut sent, decoded);
    sent
}

fn raws(decoded: &[Decoded]) -> Vec<f64> {
    let values = decoded.iter().filter_map(|what| match what {
        Decoded::Values { values, .. } => Some(values[0].raw),
        _ => None,
    });
    values.collect()
}

#[test]
fn a_late_answer_does_not_pass_for_the_next_one() {
    let mut session = digitiser();
    let mut decoded = Vec::new();
    assert_eq!(sent(&mut session, 10 * MS, &mut decoded), b"!001:SYS?\r");
    // The profile waits for 100 ms; the line is then left alone for as long again.
    assert!(sent(&mut session, 120 * MS, &mut decoded).is_empty());
    assert!(matches!(decoded[..], [Decoded::Silent { .. }]), "{decoded:?}");
    session.receive(b"+00001.0\r", 130 * MS, &mut decoded);
    assert!(matches!(decoded[1..], [Decoded::Unasked { .. }]), "{decoded:?}");
    assert_eq!(sent(&mut session, 220 * MS, &mut decoded), b"!001:SYS?\r");
    session.receive(b"+00002.0\r", 224 * MS, &mut decoded);
    assert_eq!(raws(&decoded), [2.0]);
}

#[test]
fn the_beginning_of_an_answer_does_not_pass_for_that_of_the_next_one() {
    let mut session = digitiser();
    let mut decoded = Vec::new();
    sent(&mut session, 10 * MS, &mut decoded);
    session.receive(b"+000", 20 * MS, &mut decoded);
    sent(&mut session, 400 * MS, &mut decoded);
    assert!(matches!(decoded[..], [Decoded::Damaged { n_bytes: 4, .. }, Decoded::Silent { .. }]));
    session.receive(b"+00002.0\r", 404 * MS, &mut decoded);
    assert_eq!(raws(&decoded), [2.0]);
}

#[test]
fn a_reading_lies_between_its_request_and_the_first_byte_of_its_answer() {
    let mut session = digitiser();
    let mut decoded = Vec::new();
    sent(&mut session, 10 * MS, &mut decoded);
    session.receive(b"+00002.0\r", 14 * MS, &mut decoded);
    let Decoded::Values { taken, .. } = &decoded[0] else { panic!("{decoded:?}") };
    // Nine bytes at 115200 baud take 0.78 ms.
    assert_eq!(*taken, Taken::Between(10 * MS, 14 * MS - 9 * 86_805));
}

#[test]
fn cycles_that_cannot_begin_in_time_are_counted() {
    let line = devices::port::Line {
        baud: 115_200,
        data_bits: 8,
        parity: devices::port::Parity::None,
        stop_bits: 1,
    };
    let pace = devices::profile::PaceSettings { rate_hz: Some(100.0), ..Default::default() };
    let table = "command = 40".parse().unwrap();
    let protocol = (devices::driver::driver("mantrabus").unwrap().open)(&table).unwrap();
    let mut session = Session::new(protocol, pace.pace(&line));
    session.open(0);
    let mut decoded = Vec::new();
    assert!(!sent(&mut session, 0, &mut decoded).is_empty());
    session.receive(&[0x01, 0x15], 35 * MS, &mut decoded);
    // Due at 10 ms, begun at 37: the cycles of 20 and 30 ms never come.
    assert!(!sent(&mut session, 37 * MS, &mut decoded).is_empty());
    assert!(decoded.contains(&Decoded::Missed { n_cycles: 2 }), "{decoded:?}");
    session.receive(&[0x01, 0x15], 38 * MS, &mut decoded);
    assert_eq!(session.wake_ns(), Some(40 * MS));
}
