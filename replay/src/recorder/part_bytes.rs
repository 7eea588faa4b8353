//! The bytes of a part file: MCAP records in groups, each behind its length and checksum.
//!
//! A part file is an MCAP file without chunks and without end. Before each group of records stands
//! one private record, which readers of MCAP pass over, with the group's number, length and
//! checksum. What a crash tears or a disk spoils is thus found, and the rest read in spite of it.

use std::collections::BTreeMap;

use mcap::MAGIC;
use mcap::records::{MessageHeader, op};

use crate::topics::PROFILE;

/// The library named in the header of every file we write.
pub(crate) const LIBRARY: &str = concat!("rolltank ", env!("CARGO_PKG_VERSION"));
/// Opcode and length before every record [bytes].
pub(crate) const PREFIX_BYTES: usize = 9;
/// What a group's record begins with: its opcode, which MCAP leaves to private use, its length, and
/// a word that is found in no text.
pub(crate) const GROUP_START: [u8; PREFIX_BYTES + 8] = *b"\x80\x14\0\0\0\0\0\0\0\x89RTGRP\r\n";
/// What a group's record begins with, alone.
pub(crate) const GROUP_OPCODE: u8 = GROUP_START[0];
/// Length of a group's record: number, length and checksum follow its start [bytes].
pub(crate) const GROUP_HEADER_BYTES: usize = GROUP_START.len() + 12;

/// Magic bytes and header, before the first group.
pub(crate) fn preamble() -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    record(&mut bytes, op::HEADER, |body| {
        text(body, PROFILE);
        text(body, LIBRARY);
    });
    bytes
}

/// Appends a schema of JSON messages.
pub(crate) fn schema(bytes: &mut Vec<u8>, id: u16, name: &str, definition: &[u8]) {
    record(bytes, op::SCHEMA, |body| {
        body.extend(id.to_le_bytes());
        text(body, name);
        text(body, "jsonschema");
        body.extend((definition.len() as u32).to_le_bytes());
        body.extend(definition);
    });
}

/// Appends a channel of JSON messages.
pub(crate) fn channel(bytes: &mut Vec<u8>, id: u16, schema_id: u16, topic: &str) {
    record(bytes, op::CHANNEL, |body| {
        body.extend(id.to_le_bytes());
        body.extend(schema_id.to_le_bytes());
        text(body, topic);
        text(body, crate::topics::ENCODING);
        map(body, &BTreeMap::new());
    });
}

/// Appends a message.
pub(crate) fn message(bytes: &mut Vec<u8>, header: &MessageHeader, data: &[u8]) {
    record(bytes, op::MESSAGE, |body| {
        body.extend(header.channel_id.to_le_bytes());
        body.extend(header.sequence.to_le_bytes());
        body.extend(header.log_time.to_le_bytes());
        body.extend(header.publish_time.to_le_bytes());
        body.extend(data);
    });
}

/// Appends named texts.
pub(crate) fn metadata(bytes: &mut Vec<u8>, name: &str, entries: &BTreeMap<String, String>) {
    record(bytes, op::METADATA, |body| {
        text(body, name);
        map(body, entries);
    });
}

/// Completes a group: fills in the header for which room was left before its records.
pub(crate) fn seal(group: &mut [u8], number: u32) {
    let length = (group.len() - GROUP_HEADER_BYTES) as u32;
    let checksum = checksum(number, &group[GROUP_HEADER_BYTES..]);
    let numbers = [number, length, checksum].map(u32::to_le_bytes);
    group[..GROUP_START.len()].copy_from_slice(&GROUP_START);
    group[GROUP_START.len()..GROUP_HEADER_BYTES].copy_from_slice(numbers.as_flattened());
}

/// Number, length and checksum in the header of a group; none when it is no such header.
pub(crate) fn group_header(bytes: &[u8; GROUP_HEADER_BYTES]) -> Option<(u32, u32, u32)> {
    let numbers = bytes.strip_prefix(&GROUP_START)?;
    let at =
        |place: usize| u32::from_le_bytes(std::array::from_fn(|index| numbers[4 * place + index]));
    Some((at(0), at(1), at(2)))
}

/// Checksum of a group's number and records.
pub(crate) fn checksum(number: u32, records: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&number.to_le_bytes());
    hasher.update(records);
    hasher.finalize()
}

/// Appends one record, with the length that its body turns out to have.
fn record(bytes: &mut Vec<u8>, opcode: u8, body: impl FnOnce(&mut Vec<u8>)) {
    bytes.push(opcode);
    let length_at = bytes.len();
    bytes.extend([0; 8]);
    body(bytes);
    let length = (bytes.len() - length_at - 8) as u64;
    bytes[length_at..length_at + 8].copy_from_slice(&length.to_le_bytes());
}

fn text(bytes: &mut Vec<u8>, text: &str) {
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text.as_bytes());
}

fn map(bytes: &mut Vec<u8>, entries: &BTreeMap<String, String>) {
    let length: usize = entries.iter().map(|(key, value)| 8 + key.len() + value.len()).sum();
    bytes.extend((length as u32).to_le_bytes());
    for (key, value) in entries {
        text(bytes, key);
        text(bytes, value);
    }
}

#[cfg(test)]
mod tests {
    use mcap::parse_record;
    use mcap::records::Record;

    use super::*;

    /// What the MCAP library reads in the one record that was written.
    fn parsed(bytes: &[u8]) -> Record<'_> {
        let length = u64::from_le_bytes(bytes[1..9].try_into().unwrap()) as usize;
        assert_eq!(bytes.len(), PREFIX_BYTES + length);
        parse_record(bytes[0], &bytes[PREFIX_BYTES..]).expect("it is a record")
    }

    #[test]
    fn the_library_reads_every_record_as_it_was_meant() {
        let mut bytes = Vec::new();
        schema(&mut bytes, 7, "name", b"{}");
        let Record::Schema { header, data } = parsed(&bytes) else { panic!("a schema") };
        assert_eq!((header.id, header.name.as_str(), &*data), (7, "name", b"{}".as_slice()));
        bytes.clear();
        channel(&mut bytes, 3, 7, "/roll");
        let Record::Channel(read) = parsed(&bytes) else { panic!("a channel") };
        assert_eq!((read.id, read.schema_id, read.topic.as_str()), (3, 7, "/roll"));
        bytes.clear();
        let given = MessageHeader { channel_id: 3, sequence: 9, log_time: 5, publish_time: 6 };
        message(&mut bytes, &given, b"{}");
        let Record::Message { header, data } = parsed(&bytes) else { panic!("a message") };
        assert_eq!((header, &*data), (given, b"{}".as_slice()));
        bytes.clear();
        let entries = [("a".to_owned(), "1".to_owned()), ("b".to_owned(), String::new())].into();
        metadata(&mut bytes, "rolltank", &entries);
        let Record::Metadata(read) = parsed(&bytes) else { panic!("metadata") };
        assert_eq!((read.name.as_str(), read.metadata), ("rolltank", entries));
    }

    #[test]
    fn a_group_is_told_from_one_with_another_bit() {
        let mut group = [&[0; GROUP_HEADER_BYTES], b"records".as_slice()].concat();
        seal(&mut group, 41);
        let header = group.first_chunk().expect("it has a header");
        let (number, length, sum) = group_header(header).expect("it is one");
        assert_eq!((number, length), (41, 7));
        assert_eq!(sum, checksum(41, b"records"));
        assert_ne!(sum, checksum(41, b"recorts"));
        assert_ne!(sum, checksum(42, b"records"));
    }
}
