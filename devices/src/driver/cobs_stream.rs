//! COBS frames with CRC, sequence number and device time: own electronics at kilohertz.
//!
//! The layout is in `docs/cobs_protocol.md`, with a sketch for an Arduino or Teensy.

use serde::Deserialize;

use super::{
    Content, Damage, DeviceTicks, Found, Protocol, Purpose, Request, SettingsError, ask,
    first_line, settings, value,
};
use crate::Quality;

const VERSION: u8 = 1;
const SAMPLES: u8 = 1;
const IDENTITY: u8 = 2;
const WHO: u8 = 3;
/// Version, type, sequence, microseconds, count.
const HEAD_BYTES: usize = 15;
/// Samples in a frame at most; 16 of them are an encoded frame of 84 bytes.
const SAMPLES_MAX: usize = 16;
const ENCODED_BYTES_MAX: usize = 96;
const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);

/// `[settings]` of a profile of this driver.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Settings {
    /// Values in every frame.
    pub(crate) fields: usize,
    /// Ask who it is when the port opens; off for boards that only talk.
    #[serde(default)]
    identify: bool,
}

/// What one frame says.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Frame {
    Samples { sequence: u32, time_us: u64, values: Vec<i32> },
    Identity(String),
}

struct CobsStream {
    settings: Settings,
}

pub(super) fn open(table: &toml::Table) -> Result<Box<dyn Protocol>, SettingsError> {
    let settings: Settings = settings(table)?;
    if !(1..=SAMPLES_MAX).contains(&settings.fields) {
        let fields = settings.fields;
        return Err(SettingsError(format!("fields is {fields}, allowed are 1 to {SAMPLES_MAX}")));
    }
    Ok(Box::new(CobsStream { settings }))
}

/// Adds the CRC, stuffs, and ends with the zero that ends every frame.
fn frame(mut payload: Vec<u8>) -> Vec<u8> {
    payload.extend(CRC.checksum(&payload).to_le_bytes());
    let mut bytes = cobs::encode_vec(&payload);
    bytes.push(0);
    bytes
}

/// A frame of samples as the instrument sends it.
pub(crate) fn encode_frame(sequence: u32, time_us: u64, values: &[i32]) -> Vec<u8> {
    let mut payload = vec![VERSION, SAMPLES];
    payload.extend(sequence.to_le_bytes());
    payload.extend(time_us.to_le_bytes());
    payload.push(values.len().min(SAMPLES_MAX) as u8);
    payload.extend(values.iter().take(SAMPLES_MAX).flat_map(|value| value.to_le_bytes()));
    frame(payload)
}

/// The answer to [`who`].
pub(crate) fn encode_identity(text: &str) -> Vec<u8> {
    let mut payload = vec![VERSION, IDENTITY];
    payload.extend(text.bytes().take(60));
    frame(payload)
}

/// The host's question who it is; an instrument may also say so unasked when it starts.
fn who() -> Vec<u8> {
    frame(vec![VERSION, WHO])
}

/// Whether these bytes, without their zero, are the host's question.
pub(crate) fn is_who(bytes: &[u8]) -> bool {
    who().strip_suffix(&[0]) == Some(bytes)
}

/// The frame in these bytes, without their zero.
fn decode_frame(bytes: &[u8]) -> Result<Frame, Damage> {
    let payload = cobs::decode_vec(bytes).map_err(|_| Damage::Form)?;
    let (body, sum) = payload.split_last_chunk::<2>().ok_or(Damage::Form)?;
    if CRC.checksum(body) != u16::from_le_bytes(*sum) {
        return Err(Damage::Checksum);
    }
    match body {
        [VERSION, IDENTITY, text @ ..] => {
            let text = String::from_utf8_lossy(text).trim_end().to_owned();
            Ok(Frame::Identity(text))
        }
        [VERSION, SAMPLES, ..] => samples(body).ok_or(Damage::Form),
        _ => Err(Damage::Form),
    }
}

fn samples(body: &[u8]) -> Option<Frame> {
    let (head, data) = body.split_at_checked(HEAD_BYTES)?;
    let sequence = u32::from_le_bytes(*head[2..].first_chunk()?);
    let time_us = u64::from_le_bytes(*head[6..].first_chunk()?);
    let (chunks, rest) = data.as_chunks::<4>();
    if chunks.len() != usize::from(head[14]) || !rest.is_empty() {
        return None;
    }
    let values = chunks.iter().map(|chunk| i32::from_le_bytes(*chunk)).collect();
    Some(Frame::Samples { sequence, time_us, values })
}

impl Protocol for CobsStream {
    fn fields(&self) -> Vec<String> {
        (0..self.settings.fields).map(|field| format!("value {field}")).collect()
    }

    fn opening(&self) -> Vec<Request> {
        let ask_who = self.settings.identify.then(|| ask(who(), Purpose::Identify, 0));
        ask_who.into_iter().collect()
    }

    fn cycle(&self) -> Vec<Request> {
        Vec::new()
    }

    fn decode(&mut self, bytes: &[u8], _asked: Option<&Request>) -> Found {
        let Some((encoded, n_bytes)) = first_line(bytes, |byte| byte == 0) else {
            if bytes.len() > ENCODED_BYTES_MAX {
                return Found::Noise { n_bytes: bytes.len(), damage: Damage::TooLong };
            }
            return Found::Part;
        };
        if encoded.is_empty() {
            return Found::Skip { n_bytes };
        }
        match decode_frame(encoded) {
            Ok(Frame::Identity(text)) => Found::Frame { n_bytes, content: Content::Identity(text) },
            Ok(Frame::Samples { sequence, time_us, values })
                if values.len() == self.settings.fields =>
            {
                let values = values.into_iter().enumerate();
                let content = Content::Values {
                    values: values
                        .map(|(field, raw)| value(field, f64::from(raw), Quality::GOOD))
                        .collect(),
                    sequence: Some(u64::from(sequence)),
                    ticks: Some(time_us),
                };
                Found::Frame { n_bytes, content }
            }
            Ok(Frame::Samples { .. }) => Found::Noise { n_bytes, damage: Damage::Form },
            Err(damage) => Found::Noise { n_bytes, damage },
        }
    }

    fn device_clock(&self) -> DeviceTicks {
        DeviceTicks { sequence_bits: Some(32), time_bits: Some(64), ticks_per_s: 1e6 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: [u8; 27] = [
        0x04, 0x01, 0x01, 0x07, 0x01, 0x01, 0x04, 0x87, 0xD6, 0x12, 0x01, 0x01, 0x01, 0x01, 0x06,
        0x02, 0x2E, 0xFB, 0xFF, 0xFF, 0x01, 0x02, 0x01, 0x03, 0x90, 0x5B, 0x00,
    ];

    #[test]
    fn the_documented_frame_is_written_and_read() {
        assert_eq!(encode_frame(7, 1_234_567, &[-1234, 65_536]), FRAME);
        let frame = Frame::Samples { sequence: 7, time_us: 1_234_567, values: vec![-1234, 65_536] };
        assert_eq!(decode_frame(&FRAME[..26]), Ok(frame));
    }

    #[test]
    fn any_bit_flipped_in_a_frame_is_seen() {
        let mut stream = open(&"fields = 2".parse().unwrap()).unwrap();
        for bit in 0..26 * 8 {
            let mut bytes = FRAME.to_vec();
            bytes[bit / 8] ^= 1 << (bit % 8);
            let found = stream.decode(&bytes, None);
            assert!(matches!(found, Found::Noise { .. } | Found::Skip { .. }), "bit {bit}");
        }
    }

    #[test]
    fn an_identity_comes_back_as_it_was_sent() {
        let bytes = encode_identity("rolltank-board 3");
        let mut stream = open(&"fields = 1".parse().unwrap()).unwrap();
        let content = Content::Identity("rolltank-board 3".to_owned());
        let n_bytes = bytes.len();
        assert_eq!(stream.decode(&bytes, None), Found::Frame { n_bytes, content });
    }
}
