//! What a Modbus station is asked and told once, when the link opens: who it is, and its set-up.
//!
//! Modbus Application Protocol V1.1b3: functions 17 (report server ID), 43 / 14 (read device
//! identification) and 16 (write multiple registers). Many transmitters know none of them, so
//! nothing is asked unless the settings say so.

use serde::Deserialize;

use super::modbus::{crc, read};
use super::{Content, Damage, Found, Purpose, Request, SettingsError, ask, shown};

const WRITE: u8 = 16;
const SERVER_ID: u8 = 17;
const DEVICE_ID: u8 = 43;
/// MEI type of function 43: device identification; then "the basic objects", "from the first on".
const DEVICE_ID_BODY: [u8; 3] = [14, 1, 0];
/// Station, function, MEI type, code, conformity, more, next object, number of objects.
const DEVICE_ID_HEAD_BYTES: usize = 8;
/// Registers that one request can write.
const WRITTEN_MAX: usize = 123;

/// How a station says who it is.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Identify {
    /// 17, 43, or 3 or 4 for registers that hold it.
    pub(crate) function: u8,
    /// Address on the wire of the first of them.
    #[serde(default)]
    pub(crate) address: u16,
    /// One is a number, more hold two characters each.
    #[serde(default = "one")]
    pub(crate) registers: u16,
}

/// Registers that are written when the port opens.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Write {
    pub(crate) station: u8,
    /// Address on the wire of the first register.
    pub(crate) address: u16,
    pub(crate) registers: Vec<u16>,
}

fn one() -> u16 {
    1
}

impl Identify {
    pub(super) fn check(self) -> Result<(), SettingsError> {
        let Self { function, registers, .. } = self;
        if ![3, 4, SERVER_ID, DEVICE_ID].contains(&function) {
            let known = "known are 3, 4, 17 and 43";
            return Err(SettingsError(format!("identify: function {function}, {known}")));
        }
        if !(1..=125).contains(&registers) {
            let allowed = "allowed are 1 to 125";
            return Err(SettingsError(format!("identify: {registers} registers, {allowed}")));
        }
        Ok(())
    }

    /// The question to a station.
    pub(super) fn request(self, station: u8, tag: usize) -> Request {
        let bytes = match self.function {
            SERVER_ID => summed(vec![station, SERVER_ID]),
            DEVICE_ID => summed([&[station, DEVICE_ID][..], &DEVICE_ID_BODY].concat()),
            function => read(station, function, self.address, self.registers),
        };
        ask(bytes, Purpose::Identify, tag)
    }
}

impl Write {
    pub(super) fn check(&self) -> Result<(), SettingsError> {
        let n_registers = self.registers.len();
        if !(1..=WRITTEN_MAX).contains(&n_registers) {
            let allowed = format!("allowed are 1 to {WRITTEN_MAX}");
            return Err(SettingsError(format!("set_up: {n_registers} registers, {allowed}")));
        }
        Ok(())
    }

    /// The order to the station.
    pub(super) fn request(&self, tag: usize) -> Request {
        let mut bytes = vec![self.station, WRITE];
        bytes.extend(self.address.to_be_bytes());
        bytes.extend((self.registers.len() as u16).to_be_bytes());
        bytes.push(2 * self.registers.len() as u8);
        bytes.extend(self.registers.iter().flat_map(|register| register.to_be_bytes()));
        ask(summed(bytes), Purpose::Configure, tag)
    }
}

/// The answer to a question or an order of this file.
pub(super) fn answer(bytes: &[u8], asked: &Request) -> Found {
    let noise = |damage| Found::Noise { n_bytes: 1, damage };
    let (station, function) = (asked.bytes[0], asked.bytes[1]);
    if bytes[0] != station {
        return noise(Damage::WrongStation);
    }
    let Some(said) = bytes.get(1) else { return Found::Part };
    let refused = *said == function | 0x80;
    if !refused && *said != function {
        return noise(Damage::Form);
    }
    let n_bytes = match function {
        _ if refused => Some(5),
        WRITE => Some(8),
        DEVICE_ID => device_id_bytes(bytes),
        _ => bytes.get(2).map(|count| 5 + usize::from(*count)),
    };
    let Some(frame) = n_bytes.and_then(|n_bytes| bytes.get(..n_bytes)) else { return Found::Part };
    let (body, sum) = frame.split_at(frame.len() - 2);
    if *sum != crc(body) {
        return noise(Damage::Checksum);
    }
    let content = match function {
        _ if refused => Content::Refused(format!("exception {}", body[2])),
        WRITE => Content::Accepted,
        DEVICE_ID => Content::Identity(text(&objects(body).concat())),
        3 | 4 if body.len() == 5 => {
            Content::Identity(u16::from_be_bytes([body[3], body[4]]).to_string())
        }
        _ => Content::Identity(text(&body[3..])),
    };
    Found::Frame { n_bytes: frame.len(), content }
}

/// Length of the answer to function 43; none until enough of it is there to tell.
fn device_id_bytes(bytes: &[u8]) -> Option<usize> {
    let n_objects = *bytes.get(DEVICE_ID_HEAD_BYTES - 1)?;
    let mut at = DEVICE_ID_HEAD_BYTES;
    for _ in 0..n_objects {
        at += 2 + usize::from(*bytes.get(at + 1)?);
    }
    Some(at + 2)
}

/// The texts of the objects: maker, product, version; each after a blank.
fn objects(body: &[u8]) -> Vec<Vec<u8>> {
    let mut objects = Vec::new();
    let mut rest = body.get(DEVICE_ID_HEAD_BYTES..).unwrap_or_default();
    while let [_, length, more @ ..] = rest {
        let (object, after) = more.split_at(usize::from(*length).min(more.len()));
        objects.push([b" ", object].concat());
        rest = after;
    }
    objects
}

/// What of it is text; all of it in hexadecimal where nothing is.
fn text(bytes: &[u8]) -> String {
    let kept = bytes.iter().filter(|byte| byte.is_ascii_graphic() || **byte == b' ');
    let text: String = kept.map(|byte| char::from(*byte)).collect();
    let text = text.trim();
    if text.is_empty() { shown(bytes) } else { text.to_owned() }
}

fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(crc(&bytes));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(identify: Identify, body: &[u8]) -> String {
        let asked = identify.request(9, 0);
        let reply = summed(body.to_vec());
        // Every beginning of it is too little to tell.
        for n_bytes in 1..reply.len() {
            assert_eq!(answer(&reply[..n_bytes], &asked), Found::Part, "{n_bytes}");
        }
        match answer(&reply, &asked) {
            Found::Frame { n_bytes, content: Content::Identity(text) } => {
                assert_eq!(n_bytes, reply.len());
                text
            }
            found => panic!("{found:?}"),
        }
    }

    #[test]
    fn the_manuals_register_101_is_executed() {
        // DSC user manual p. 53.
        let order = Write { station: 17, address: 100, registers: vec![0, 0] }.request(0);
        let bytes = [0x11, 0x10, 0x00, 0x64, 0x00, 0x02, 0x04, 0x00, 0x00, 0x00, 0x00, 0xA0, 0xB4];
        assert_eq!(order.bytes, bytes);
        let done = [0x11, 0x10, 0x00, 0x64, 0x00, 0x02, 0x02, 0x87];
        let accepted = Found::Frame { n_bytes: 8, content: Content::Accepted };
        assert_eq!(answer(&done, &order), accepted);
        let other = [0x12, 0x10, 0x00, 0x64, 0x00, 0x02, 0x02, 0x87];
        let noise = Found::Noise { n_bytes: 1, damage: Damage::WrongStation };
        assert_eq!(answer(&other, &order), noise);
    }

    #[test]
    fn a_station_says_who_it_is_in_each_way_that_there_is() {
        let ask = |function, registers| Identify { function, address: 7, registers };
        // An identifier, the run indicator, and what the maker adds.
        let reply = [&[9, 17, 8, 0x05, 0xFF][..], b"PR-200"].concat();
        assert_eq!(identity(ask(17, 1), &reply), "PR-200");
        assert_eq!(identity(ask(17, 1), &[9, 17, 2, 0x05, 0xFF]), "05 FF");
        let head = [9, 43, 14, 1, 1, 0, 0, 3, 0, 4];
        let reply = [&head[..], b"Acme", &[1, 4], b"P200", &[2, 3], b"1.2"].concat();
        assert_eq!(identity(ask(43, 1), &reply), "Acme P200 1.2");
        assert_eq!(identity(ask(3, 1), &[9, 3, 2, 0x12, 0x34]), "4660");
        let reply = [&[9, 4, 6][..], b"PR-2\0\0"].concat();
        assert_eq!(identity(ask(4, 3), &reply), "PR-2");
    }

    #[test]
    fn a_station_that_does_not_know_the_function_refuses() {
        let asked = Identify { function: 17, address: 0, registers: 1 }.request(9, 0);
        let content = Content::Refused("exception 1".to_owned());
        let found = answer(&summed(vec![9, 0x91, 1]), &asked);
        assert_eq!(found, Found::Frame { n_bytes: 5, content });
    }
}
