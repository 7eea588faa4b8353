//! Transmitters on one line that answer Modbus RTU functions 3, 4, 16 and 17.

use super::line_pace::LinePace;
use super::{Emulator, Faults, Opened, Parts, Signal};
use crate::driver::{ModbusSettings, NumberType, modbus_crc};

const WRITE: u8 = 16;
const SERVER_ID: u8 = 17;
const DEVICE_ID: u8 = 43;
const ILLEGAL_FUNCTION: u8 = 1;
const ILLEGAL_ADDRESS: u8 = 2;
/// An identifier, the run indicator, and what the maker adds.
const IDENTITY: &[u8] = b"\x05\xFFrolltank emulated transmitter";

struct ModbusTransmitters {
    settings: ModbusSettings,
    pace: LinePace,
    signal: Signal,
    heard: Vec<u8>,
}

pub(super) fn open(parts: Parts<'_>) -> Opened {
    let (settings, pace, signal) = parts.read()?;
    Ok(Box::new(ModbusTransmitters { settings, pace, signal, heard: Vec::new() }))
}

impl ModbusTransmitters {
    /// The registers of a field, as bytes on the wire.
    fn registers(&self, number: usize, host_s: f64, faults: &Faults) -> Vec<u8> {
        let field = &self.settings.fields[number];
        let raw = (self.signal)(number, host_s);
        let long = |bytes: [u8; 4]| match field.order {
            Some(order) => order.turn(bytes).to_vec(),
            None => bytes.to_vec(),
        };
        match field.number {
            NumberType::Int16 => {
                (faults.limited(raw, 32_767.0).round() as i16).to_be_bytes().to_vec()
            }
            NumberType::Uint16 => {
                (faults.limited(raw, 65_535.0).round() as u16).to_be_bytes().to_vec()
            }
            NumberType::Int32 => {
                long((faults.limited(raw, 2_147_483_647.0).round() as i32).to_be_bytes())
            }
            NumberType::Uint32 => {
                long((faults.limited(raw, 4_294_967_295.0).round() as u32).to_be_bytes())
            }
            NumberType::Float32 => {
                let raw = if faults.saturated { f64::NAN } else { raw };
                long((raw as f32).to_be_bytes())
            }
        }
    }

    /// The answer to a whole request without its check sum; others' are met by silence.
    fn answer(&mut self, request: &[u8], now_s: f64, faults: &mut Faults) -> Option<Vec<u8>> {
        let (station, function) = (request[0], request[1]);
        if !self.settings.fields.iter().any(|field| field.station == station) {
            return None;
        }
        let mut reply = match function {
            3 | 4 => {
                let reply = self.read(request, now_s, faults);
                Some(reply).filter(|_| !faults.skips())?
            }
            WRITE => request[..6].to_vec(),
            SERVER_ID => [&[station, function, IDENTITY.len() as u8], IDENTITY].concat(),
            _ => vec![station, function | 0x80, ILLEGAL_FUNCTION],
        };
        reply.extend(modbus_crc(&reply));
        Some(reply)
    }

    /// The registers asked for, or that they do not exist.
    fn read(&mut self, request: &[u8], now_s: f64, faults: &mut Faults) -> Vec<u8> {
        let (station, function) = (request[0], request[1]);
        let start = u16::from_be_bytes([request[2], request[3]]);
        let n_registers = u16::from_be_bytes([request[4], request[5]]);
        let host_s = self.pace.newest(usize::from(station), now_s, faults).host_s;
        let mut data = vec![0; 2 * usize::from(n_registers)];
        let mut any = false;
        for (number, field) in self.settings.fields.iter().enumerate() {
            if (field.station, field.function) != (station, function) || field.address < start {
                continue;
            }
            let at = 2 * usize::from(field.address - start);
            let bytes = self.registers(number, host_s, faults);
            if let Some(place) = data.get_mut(at..at + bytes.len()) {
                place.copy_from_slice(&bytes);
                any = true;
            }
        }
        if !any || n_registers > 125 {
            return vec![station, function | 0x80, ILLEGAL_ADDRESS];
        }
        let mut reply = vec![station, function, data.len() as u8];
        reply.extend(data);
        reply
    }
}

/// Length of the request that begins these bytes; none until that can be told.
fn request_bytes(bytes: &[u8]) -> Option<usize> {
    Some(match *bytes.get(1)? {
        SERVER_ID => 4,
        DEVICE_ID => 7,
        WRITE => 9 + usize::from(*bytes.get(6)?),
        _ => 8,
    })
}

impl Emulator for ModbusTransmitters {
    fn receive(&mut self, bytes: &[u8], now_s: f64, faults: &mut Faults, out: &mut Vec<u8>) {
        self.heard.extend_from_slice(bytes);
        while let Some(n_bytes) = request_bytes(&self.heard).filter(|n| *n <= self.heard.len()) {
            let (body, sum) = self.heard[..n_bytes].split_at(n_bytes - 2);
            if *sum != modbus_crc(body) {
                self.heard.remove(0);
                continue;
            }
            let body = body.to_vec();
            self.heard.drain(..n_bytes);
            out.extend(self.answer(&body, now_s, faults).into_iter().flatten());
        }
    }

    fn tick(&mut self, _now_s: f64, _faults: &mut Faults, _out: &mut Vec<u8>) {}

    fn restart(&mut self, now_s: f64) {
        self.pace.restart(now_s);
    }
}
