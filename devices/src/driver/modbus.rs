//! Modbus RTU: holding and input registers of any transmitter.
//!
//! Nothing on the wire tells the order of the two words of a 32-bit number, so the settings must.
//! All fields of a station come in one request, because a counter read in two would tear.

use serde::Deserialize;

use super::modbus_opening::{self, Identify, Write};
use super::{
    Content, Damage, FieldValue, Found, Protocol, Purpose, Request, SettingsError, ask, plain,
    settings, value,
};
use crate::Quality;

/// Registers that one answer can carry.
const REGISTERS_MAX: u16 = 125;
const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_MODBUS);

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    pub(crate) fields: Vec<Field>,
    /// How each station says who it is; many cannot.
    #[serde(default)]
    pub(crate) identify: Option<Identify>,
    #[serde(default)]
    pub(crate) set_up: Vec<Write>,
}

/// One number in the registers of a station.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Field {
    #[serde(default = "station_one")]
    pub(crate) station: u8,
    /// 3 for holding registers, 4 for input registers.
    pub(crate) function: u8,
    /// Address on the wire: "register 40001" is address 0 of function 3.
    pub(crate) address: u16,
    #[serde(rename = "type")]
    pub(crate) number: NumberType,
    /// Mandatory for 32-bit numbers.
    #[serde(default)]
    pub(crate) order: Option<WordOrder>,
}

/// What the registers hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum NumberType {
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
}

/// Order of the four bytes of a 32-bit number on the wire, A the highest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum WordOrder {
    Abcd,
    Cdab,
    Badc,
    Dcba,
}

impl WordOrder {
    /// From the wire to ABCD, and back: each order is its own inverse.
    pub(crate) fn turn(self, [a, b, c, d]: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Abcd => [a, b, c, d],
            Self::Cdab => [c, d, a, b],
            Self::Badc => [b, a, d, c],
            Self::Dcba => [d, c, b, a],
        }
    }
}

fn station_one() -> u8 {
    1
}

/// One request: the fields of one station and function, whose registers lie close together.
struct Block {
    station: u8,
    function: u8,
    start: u16,
    n_registers: u16,
    /// Field number and register offset.
    fields: Vec<(usize, u16)>,
}

struct Modbus {
    settings: Settings,
    blocks: Vec<Block>,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    if settings.fields.is_empty() {
        return Err(SettingsError("fields is empty".to_owned()));
    }
    settings.identify.map_or(Ok(()), Identify::check)?;
    settings.set_up.iter().try_for_each(Write::check)?;
    let mut blocks: Vec<Block> = Vec::new();
    for (number, field) in settings.fields.iter().enumerate() {
        let Field { station, function, address, .. } = *field;
        if function != 3 && function != 4 {
            return Err(SettingsError(format!("function {function}, known are 3 and 4")));
        }
        if !(1..=247).contains(&station) {
            return Err(SettingsError(format!("station {station}, allowed are 1 to 247")));
        }
        if n_registers(field.number) == 2 && field.order.is_none() {
            let orders = "ABCD, CDAB, BADC or DCBA";
            return Err(SettingsError(format!("register {address} needs order = {orders}")));
        }
        extend(&mut blocks, number, field)
            .ok_or_else(|| SettingsError(format!("register {address} is beyond 65535")))?;
    }
    Ok(Box::new(Modbus { settings, blocks }))
}

fn extend(blocks: &mut Vec<Block>, number: usize, field: &Field) -> Option<()> {
    let end = field.address.checked_add(n_registers(field.number))?;
    for block in blocks.iter_mut() {
        if (block.station, block.function) != (field.station, field.function) {
            continue;
        }
        let start = block.start.min(field.address);
        let block_end = (block.start + block.n_registers).max(end);
        if block_end - start <= REGISTERS_MAX {
            let shift = block.start - start;
            block.fields.iter_mut().for_each(|(_, offset)| *offset += shift);
            block.fields.push((number, field.address - start));
            (block.start, block.n_registers) = (start, block_end - start);
            return Some(());
        }
    }
    blocks.push(Block {
        station: field.station,
        function: field.function,
        start: field.address,
        n_registers: end - field.address,
        fields: vec![(number, 0)],
    });
    Some(())
}

fn n_registers(number: NumberType) -> u16 {
    match number {
        NumberType::Int16 | NumberType::Uint16 => 1,
        NumberType::Int32 | NumberType::Uint32 | NumberType::Float32 => 2,
    }
}

/// CRC-16/MODBUS, low byte first as it travels.
pub(crate) fn crc(bytes: &[u8]) -> [u8; 2] {
    CRC.checksum(bytes).to_le_bytes()
}

/// A request to read registers.
pub(crate) fn read(station: u8, function: u8, start: u16, n_registers: u16) -> Vec<u8> {
    let mut bytes = vec![station, function];
    bytes.extend(start.to_be_bytes());
    bytes.extend(n_registers.to_be_bytes());
    bytes.extend(crc(&bytes));
    bytes
}

impl Modbus {
    fn number(&self, field: usize, data: &[u8]) -> Option<FieldValue> {
        let Field { number, order, .. } = self.settings.fields[field];
        let word = |at: usize| Some(u16::from_be_bytes([*data.get(at)?, *data.get(at + 1)?]));
        let long = || Some(order?.turn(*data.first_chunk::<4>()?));
        let raw = match number {
            NumberType::Int16 => f64::from(word(0)?.cast_signed()),
            NumberType::Uint16 => f64::from(word(0)?),
            NumberType::Int32 => f64::from(i32::from_be_bytes(long()?)),
            NumberType::Uint32 => f64::from(u32::from_be_bytes(long()?)),
            NumberType::Float32 => f64::from(f32::from_be_bytes(long()?)),
        };
        // A transmitter without a reading sends NaN: the sensor is at fault, not the line.
        let fault = !raw.is_finite();
        let raw = if fault { 0.0 } else { raw };
        Some(value(field, raw, Quality::GOOD.with_if(fault, Quality::SENSOR_FAULT)))
    }
}

impl Protocol for Modbus {
    fn fields(&self) -> Vec<String> {
        let name =
            |field: &Field| format!("{}:{}:{}", field.station, field.function, field.address);
        self.settings.fields.iter().map(name).collect()
    }

    fn stations(&self) -> Vec<u16> {
        let mut stations: Vec<u16> =
            self.blocks.iter().map(|block| u16::from(block.station)).collect();
        stations.sort_unstable();
        stations.dedup();
        stations
    }

    fn opening(&self) -> Vec<Request> {
        let stations = self.stations().into_iter().map(|station| station as u8).enumerate();
        let identify =
            |identify: Identify| stations.map(move |(tag, station)| identify.request(station, tag));
        let mut requests: Vec<Request> =
            self.settings.identify.map(identify).into_iter().flatten().collect();
        requests.extend(self.settings.set_up.iter().map(|write| write.request(0)));
        requests
    }

    fn cycle(&self) -> Vec<Request> {
        let request = |(tag, block): (usize, &Block)| {
            let bytes = read(block.station, block.function, block.start, block.n_registers);
            ask(bytes, Purpose::Read, tag)
        };
        self.blocks.iter().enumerate().map(request).collect()
    }

    fn station_asked(&self, request: &Request) -> Option<u16> {
        request.bytes.first().map(|station| u16::from(*station))
    }

    fn fields_asked(&self, request: &Request) -> Vec<usize> {
        let block = self.blocks.get(request.tag);
        let fields = block.into_iter().flat_map(|block| &block.fields);
        fields.map(|(field, _)| *field).collect()
    }

    fn decode(&mut self, bytes: &[u8], asked: Option<&Request>) -> Found {
        if let Some(asked) = asked.filter(|asked| asked.purpose != Purpose::Read) {
            return modbus_opening::answer(bytes, asked);
        }
        let noise = |damage| Found::Noise { n_bytes: 1, damage };
        let block = &self.blocks[asked.map_or(0, |asked| asked.tag).min(self.blocks.len() - 1)];
        if bytes[0] != block.station {
            return noise(Damage::WrongStation);
        }
        let Some(function) = bytes.get(1) else { return Found::Part };
        let refused = *function == block.function | 0x80;
        if !refused && *function != block.function {
            return noise(Damage::Form);
        }
        let Some(count) = bytes.get(2) else { return Found::Part };
        if !refused && u16::from(*count) != 2 * block.n_registers {
            return noise(Damage::Form);
        }
        let n_bytes = if refused { 5 } else { 5 + usize::from(*count) };
        let Some(frame) = bytes.get(..n_bytes) else { return Found::Part };
        let (body, sum) = frame.split_at(n_bytes - 2);
        if *sum != crc(body) {
            return noise(Damage::Checksum);
        }
        if refused {
            let content = Content::Refused(format!("exception {count}"));
            return Found::Frame { n_bytes, content };
        }
        let data = &body[3..];
        let values: Option<Vec<FieldValue>> = block
            .fields
            .iter()
            .map(|(field, offset)| self.number(*field, &data[2 * usize::from(*offset)..]))
            .collect();
        match values {
            Some(values) => Found::Frame { n_bytes, content: plain(values) },
            None => noise(Damage::Form),
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
mod tests {
    use super::*;

    fn open_one(function: u8, number: &str, order: &str) -> Box<dyn Protocol> {
        let field = format!("function = {function}\naddress = 0\ntype = \"{number}\"\n{order}");
        open(&format!("[[fields]]\n{field}").parse().unwrap()).unwrap()
    }

    fn read_one(protocol: &mut dyn Protocol, bytes: &[u8]) -> f64 {
        let asked = protocol.cycle()[0].clone();
        match protocol.decode(bytes, Some(&asked)) {
            Found::Frame { n_bytes, content: Content::Values { values, .. } } => {
                assert_eq!(n_bytes, bytes.len());
                values[0].raw
            }
            found => panic!("{found:?}"),
        }
    }

    #[test]
    fn the_published_requests_are_written() {
        assert_eq!(read(1, 3, 0, 2), [0x01, 0x03, 0x00, 0x00, 0x00, 0x02, 0xC4, 0x0B]);
        assert_eq!(read(1, 4, 0, 2), [0x01, 0x04, 0x00, 0x00, 0x00, 0x02, 0x71, 0xCB]);
        // DSC user manual p. 53.
        assert_eq!(read(0x34, 3, 12, 2), [0x34, 0x03, 0x00, 0x0C, 0x00, 0x02, 0x01, 0xAD]);
        assert_eq!(crc(b"123456789"), [0x37, 0x4B]);
    }

    #[test]
    fn the_published_answers_are_read() {
        let twelve = f64::from(12.345f32);
        let mut high_first = open_one(3, "float32", "order = \"ABCD\"");
        let reply = [0x01, 0x03, 0x04, 0x41, 0x45, 0x85, 0x1F, 0xDC, 0x82];
        assert_eq!(read_one(high_first.as_mut(), &reply), twelve);
        let reply = [0x01, 0x03, 0x04, 0xC0, 0x70, 0x00, 0x00, 0xC7, 0xE8];
        assert_eq!(read_one(high_first.as_mut(), &reply), -3.75);
        let mut swapped = open_one(3, "float32", "order = \"CDAB\"");
        let reply = [0x01, 0x03, 0x04, 0x85, 0x1F, 0x41, 0x45, 0x13, 0x5A];
        assert_eq!(read_one(swapped.as_mut(), &reply), twelve);
        let mut input = open_one(4, "float32", "order = \"ABCD\"");
        let reply = [0x01, 0x04, 0x04, 0x41, 0x45, 0x85, 0x1F, 0xDD, 0x35];
        assert_eq!(read_one(input.as_mut(), &reply), twelve);
        // DSC user manual p. 53: low word first.
        let text = "[[fields]]\nstation = 52\nfunction = 3\naddress = 12\ntype = \"float32\"\n\
                    order = \"CDAB\"";
        let mut cell = open(&text.parse().unwrap()).unwrap();
        let reply = [0x34, 0x03, 0x04, 0xED, 0x51, 0xC2, 0x5C, 0xAA, 0xD4];
        assert!((read_one(cell.as_mut(), &reply) + 55.2317).abs() < 1e-4);
    }

    #[test]
    fn the_four_orders_of_a_number_are_its_published_bytes() {
        let orders = [
            (WordOrder::Abcd, [0x41, 0x45, 0x85, 0x1F]),
            (WordOrder::Cdab, [0x85, 0x1F, 0x41, 0x45]),
            (WordOrder::Badc, [0x45, 0x41, 0x1F, 0x85]),
            (WordOrder::Dcba, [0x1F, 0x85, 0x45, 0x41]),
        ];
        for (order, bytes) in orders {
            assert_eq!(f32::from_be_bytes(order.turn(bytes)), 12.345);
            assert_eq!(order.turn(12.345f32.to_be_bytes()), bytes);
        }
    }

    #[test]
    fn an_exception_is_a_refusal_and_a_broken_answer_is_noise() {
        let mut registers = open_one(3, "float32", "order = \"ABCD\"");
        let content = Content::Refused("exception 2".to_owned());
        let found = registers.decode(&[0x01, 0x83, 0x02, 0xC0, 0xF1], None);
        assert_eq!(found, Found::Frame { n_bytes: 5, content });
        let broken = [0x01, 0x03, 0x04, 0x41, 0x45, 0x85, 0x1E, 0xDC, 0x82];
        let noise = Found::Noise { n_bytes: 1, damage: Damage::Checksum };
        assert_eq!(registers.decode(&broken, None), noise);
    }

    #[test]
    fn fields_of_one_station_come_in_one_request() {
        let text = "[[fields]]\nfunction = 4\naddress = 10\ntype = \"uint32\"\norder = \"ABCD\"\n\
                    [[fields]]\nfunction = 4\naddress = 6\ntype = \"int16\"";
        let registers = open(&text.parse().unwrap()).unwrap();
        let cycle = registers.cycle();
        assert_eq!(cycle.len(), 1);
        assert_eq!(cycle[0].bytes, read(1, 4, 6, 6));
    }

    #[test]
    fn a_number_of_two_registers_needs_its_order() {
        let text = "[[fields]]\nfunction = 3\naddress = 4\ntype = \"float32\"";
        let error = open(&text.parse().unwrap()).err().unwrap();
        assert!(error.to_string().contains("register 4 needs order"), "{error}");
    }
}
