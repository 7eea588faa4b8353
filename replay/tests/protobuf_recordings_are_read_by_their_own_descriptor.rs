//! MCAP files whose messages are protobuf, described by the schema in the file.

use std::collections::BTreeMap;
use std::io::Cursor;

use devices::Quantity::Roll;
use mcap::WriteOptions;
use mcap::records::MessageHeader;
use proptest::prelude::*;
use replay::Columns;

use crate::recordings::{channel, folder, play, play_whole, refusal, write};

/// A field whose value is text, bytes or a message.
fn bytes(number: u8, value: &[u8]) -> Vec<u8> {
    [&[number << 3 | 2, value.len() as u8], value].concat()
}

/// A field of a descriptor: name, number, label (1 single, 3 repeated), type, type name.
fn field(name: &str, number: u8, label: u8, kind: u8, type_name: &str) -> Vec<u8> {
    let type_name = if type_name.is_empty() { vec![] } else { bytes(6, type_name.as_bytes()) };
    let numbers = vec![0x18, number, 0x20, label, 0x28, kind];
    bytes(2, &[bytes(1, name.as_bytes()), numbers, type_name].concat())
}

/// What `protoc --descriptor_set_out` makes of this file, byte for byte but for the JSON names:
///
/// ```proto
/// syntax = "proto3";
/// package tank;
/// message Imu {
///   message Angle { double roll = 1; }
///   Angle angle = 1;
///   repeated float force = 2;
///   string name = 3;
/// }
/// ```
fn descriptor() -> Vec<u8> {
    let angle = bytes(3, &[bytes(1, b"Angle"), field("roll", 1, 1, 1, "")].concat());
    let imu = [
        bytes(1, b"Imu"),
        field("angle", 1, 1, 11, ".tank.Imu.Angle"),
        field("force", 2, 3, 2, ""),
        field("name", 3, 1, 9, ""),
        angle,
    ];
    let imu = bytes(4, &imu.concat());
    let file = [bytes(1, b"tank.proto"), bytes(2, b"tank"), imu, bytes(12, b"proto3")];
    bytes(1, &file.concat())
}

/// A message with a roll angle, or with none of its fields set; proto3 leaves zeros out.
fn imu(roll: Option<f64>) -> Vec<u8> {
    let Some(roll) = roll else { return Vec::new() };
    let roll = if roll == 0.0 { vec![] } else { [&[0x09], &roll.to_le_bytes()[..]].concat() };
    let force = [1.5_f32.to_le_bytes(), (-2.5_f32).to_le_bytes()].concat();
    [bytes(1, &roll), bytes(2, &force), bytes(3, b"imu")].concat()
}

fn recorded(schema: &str, definition: &[u8], messages: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let options = WriteOptions::new().compression_threads(0);
    let mut writer = options.create(&mut bytes).expect("it starts");
    let schema = writer.add_schema(schema, "protobuf", definition).expect("it is added");
    let channel_id =
        writer.add_channel(schema, "/imu", "protobuf", &BTreeMap::new()).expect("it is added");
    for (sequence, message) in (0..).zip(messages) {
        let log_time = 10_000_000 * u64::from(sequence);
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, message).expect("it is written");
    }
    writer.finish().expect("it is completed");
    drop(writer);
    bytes.into_inner()
}

fn roll_by(path: &str) -> Columns {
    let mut roll = channel(Roll, path);
    roll.topic = Some("/imu".to_owned());
    Columns { channels: vec![roll], ..Columns::default() }
}

#[test]
fn nested_and_repeated_fields_are_read_and_unset_messages_are_missing_samples() {
    let folder = folder();
    let messages = [imu(Some(0.1)), imu(None), imu(Some(0.0))];
    let path = write(&folder, "story.mcap", recorded("tank.Imu", &descriptor(), &messages));
    let played = play_whole(&path, &roll_by("angle.roll"));
    assert_eq!(played.of(Roll), [(0.0, 0.1), (0.02, 0.0)]);
    assert!(played.note(replay::Severity::Mended, "without a value").contains("1 message"));

    let messages = [imu(Some(0.1)), imu(Some(0.2))];
    let path = write(&folder, "story.mcap", recorded("tank.Imu", &descriptor(), &messages));
    assert_eq!(play_whole(&path, &roll_by("force.1")).of(Roll), [(0.0, -2.5), (0.01, -2.5)]);
}

#[test]
fn what_is_no_finite_number_is_told_with_topic_and_message() {
    let folder = folder();
    let file = |messages: &[Vec<u8>]| {
        write(&folder, "story.mcap", recorded("tank.Imu", &descriptor(), messages))
    };
    let place = "\"story.mcap\" topic \"/imu\", message";
    let path = file(&[imu(Some(0.5)), imu(Some(f64::NAN))]);
    let (message, _) = refusal(&path, &roll_by("angle.roll"));
    assert_eq!(
        message,
        format!("{place} 2: field \"angle.roll\" is NaN, not a finite number in SI units")
    );
    let (message, _) = refusal(&path, &roll_by("angle.pitch"));
    assert_eq!(message, format!("{place} 1: field \"angle.pitch\" is not there"));
    let (message, _) = refusal(&path, &roll_by("angle"));
    assert_eq!(message, format!("{place} 1: field \"angle\" is a message, not a number"));
    let (message, _) = refusal(&path, &roll_by("force.2"));
    assert_eq!(message, format!("{place} 1: field \"force.2\" is not there"));
    let (message, _) = refusal(&path, &roll_by("name"));
    assert_eq!(message, format!("{place} 1: field \"name\" is text, not a number"));
    let (message, _) = refusal(&file(&[vec![0xff; 7]]), &roll_by("angle.roll"));
    assert!(message.contains("is unreadable, as the message is not the protobuf"), "{message}");
}

#[test]
fn a_schema_that_does_not_describe_the_messages_is_told() {
    let folder = folder();
    let refused = |schema, definition: &[u8]| {
        let bytes = recorded(schema, definition, &[imu(Some(0.5))]);
        refusal(&write(&folder, "story.mcap", bytes), &roll_by("angle.roll")).0
    };
    let place = "\"story.mcap\" topic \"/imu\" has no usable schema:";
    let message = refused("tank.Compass", &descriptor());
    assert_eq!(message, format!("{place} it does not define \"tank.Compass\""));
    let message = refused("tank.Imu", b"not a descriptor");
    assert_eq!(message, format!("{place} it does not define \"tank.Imu\""));
}

proptest! {
    #[test]
    fn changed_descriptors_and_messages_never_panic(
        at in any::<prop::sample::Index>(),
        byte in any::<u8>(),
        message in prop::collection::vec(any::<u8>(), 0..40),
    ) {
        let folder = folder();
        let mut definition = descriptor();
        let at = at.index(definition.len());
        definition[at] = byte;
        let bytes = recorded("tank.Imu", &definition, &[imu(Some(0.5)), message]);
        let path = write(&folder, "story.mcap", bytes);
        if let Ok(played) = play(&path, &roll_by("angle.roll")) {
            prop_assert!(played.samples.iter().all(|sample| sample.value.is_finite()));
        }
    }
}
