//! MCAP files of other programs: nested fields, other clocks, disorder, and what cannot be read.

use std::collections::BTreeMap;
use std::io::Cursor;

use devices::Quantity::{Force, Roll};
use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions};
use replay::Severity::Mended;
use replay::{Columns, import};

use crate::recordings::{channel, folder, play, play_files, play_whole, refusal, time, write};

/// A file with messages (topic, log time [ns], text) in the order given.
pub(crate) fn mcap_file(
    options: WriteOptions,
    encoding: &str,
    messages: &[(&str, u64, String)],
) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = options.compression_threads(0).create(&mut bytes).expect("it starts");
    let mut channels = BTreeMap::new();
    for (sequence, (topic, log_time, text)) in (0..).zip(messages) {
        let channel_id = *channels.entry(*topic).or_insert_with(|| {
            writer.add_channel(0, topic, encoding, &BTreeMap::new()).expect("it is added")
        });
        let header = MessageHeader { channel_id, sequence, log_time: *log_time, publish_time: 7 };
        writer.write_to_known_channel(&header, text.as_bytes()).expect("it is written");
    }
    writer.finish().expect("it is completed");
    drop(writer);
    bytes.into_inner()
}

fn roll_by(topic: &str, path: &str) -> Columns {
    let mut roll = channel(Roll, path);
    roll.topic = Some(topic.to_owned());
    Columns { time: None, sample_rate_hz: None, channels: vec![roll] }
}

fn imu(roll: f64, stamp_ms: u64) -> String {
    format!(r#"{{"stamp":{{"ms":{stamp_ms}}},"angle":{{"pitch":9,"roll":{roll:?}}}}}"#)
}

/// Log times begin at this UNIX time [ns].
const NOON_NS: u64 = 1_700_000_000_000_000_000;

fn day() -> Vec<(&'static str, u64, String)> {
    let load = |force: f64| format!(r#"{{"wrench":{{"force":[0,{force:?},0]}}}}"#);
    vec![
        ("/load", NOON_NS, load(10.0)),
        ("/imu", NOON_NS + 500_000_000, imu(0.25, 4000)),
        ("/imu", NOON_NS + 510_000_000, imu(0.5, 4010)),
        ("/load", NOON_NS + 1_000_000_000, load(11.0)),
        ("/imu", NOON_NS + 520_000_001, imu(0.75, 4020)),
    ]
}

#[test]
fn nested_fields_are_read_with_times_from_the_first_message_of_the_recording() {
    let mut given = roll_by("/imu", "angle.roll");
    let mut force = channel(Force, "wrench.force.1");
    force.topic = Some("/load".to_owned());
    force.si_per_unit = 2.0;
    given.channels.push(force);
    let folder = folder();
    let options: [fn(WriteOptions) -> WriteOptions; 5] = [
        |options| options,
        |options| options.compression(Some(Compression::Lz4)),
        |options| options.compression(None),
        |options| options.use_chunks(false),
        |options| options.emit_summary_records(false).emit_summary_offsets(false),
    ];
    for with in options {
        let bytes = mcap_file(with(WriteOptions::new()), "json", &day());
        let played = play_whole(&write(&folder, "story.mcap", bytes), &given);
        assert_eq!(played.of(Roll), [(0.5, 0.25), (0.51, 0.5), (0.520_000_001, 0.75)]);
        assert_eq!(played.of(Force), [(0.0, 20.0), (1.0, 22.0)]);
        assert!(played.samples.is_sorted_by(|a, b| a.time_s <= b.time_s));
        assert_eq!(played.notes, []);
    }
}

#[test]
fn files_of_one_recording_share_their_first_message() {
    let folder = folder();
    let of = |topic: &str| -> Vec<_> {
        day().into_iter().filter(|message| message.0 == topic).collect()
    };
    let file =
        |name, topic| write(&folder, name, mcap_file(WriteOptions::new(), "json", &of(topic)));
    let mut given = roll_by("/imu", "angle.roll");
    let mut force = channel(Force, "wrench.force.1");
    force.topic = Some("/load".to_owned());
    given.channels.push(force);
    let files = [(Some(Roll), file("imu.mcap", "/imu")), (Some(Force), file("load.mcap", "/load"))];
    let played = play_files(&files, &given).expect("it opens");
    assert_eq!(played.of(Roll)[0], (0.5, 0.25), "half a second after the first load message");

    // The import keeps the time of day, so that other programs show it.
    let target = folder.path().join("both.mcap");
    import("both", &files, &given, &target, "", &mut |_, _| {}).expect("the import succeeds");
    let bytes = std::fs::read(&target).expect("it is there");
    let mut messages = mcap::MessageStream::new(&bytes).expect("it can be streamed");
    let first = messages.next().expect("there is one").expect("it is whole");
    assert_eq!(first.log_time, NOON_NS);
    assert_eq!(play_whole(&target, &given).samples, played.samples);
}

#[test]
fn a_mapped_time_field_takes_the_place_of_the_log_time() {
    let folder = folder();
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &day()));
    let mut given = roll_by("/imu", "angle.roll");
    given.time = Some(time("stamp.ms"));
    given.time.as_mut().expect("just set").seconds_per_unit = 1e-3;
    let played = play_whole(&path, &given);
    let times: Vec<_> = played.samples.iter().map(|sample| sample.time_s).collect();
    assert_eq!(times, [4.0, 4010.0 * 1e-3, 4020.0 * 1e-3]);
}

#[test]
fn messages_out_of_order_are_sorted_within_a_window_and_told() {
    let folder = folder();
    let times_ms = [0, 10, 30, 20, 40, 60, 50];
    let messages: Vec<_> =
        times_ms.iter().map(|ms| ("/imu", 1_000_000 * ms, imu(*ms as f64, 0))).collect();
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &messages));
    let played = play_whole(&path, &roll_by("/imu", "angle.roll"));
    let values: Vec<_> = played.samples.iter().map(|sample| sample.value).collect();
    assert_eq!(values, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
    let note = played.note(Mended, "out of order");
    assert!(note.contains("2 messages, the first at number 4"), "{note}");

    let late: Vec<_> =
        (1..=6000_u64).chain([500]).map(|ms| ("/imu", 1_000_000 * ms, imu(0.0, 0))).collect();
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &late));
    let (message, hint) = refusal(&path, &roll_by("/imu", "angle.roll"));
    assert!(
        message.starts_with(
            "\"story.mcap\" topic \"/imu\", message 6001: time runs backwards, 0.499 s"
        ),
        "{message}"
    );
    assert!(!hint.is_empty());
}

#[test]
fn null_is_a_missing_sample_and_repeated_log_times_are_spread() {
    let folder = folder();
    let messages = [(0, "1.0"), (10, "null"), (20, "2.0"), (20, "3.0"), (30, "4.0")];
    let messages =
        messages.map(|(ms, roll)| ("/r", 1_000_000 * ms, format!("{{\"roll\":{roll}}}")));
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &messages));
    let played = play_whole(&path, &roll_by("/r", "roll"));
    assert_eq!(played.of(Roll), [(0.0, 1.0), (0.02, 2.0), (0.025, 3.0), (0.03, 4.0)]);
    assert!(played.note(Mended, "without a value").contains("1 message, at number 2"));
    assert!(played.note(Mended, "repeating a time stamp").contains("1 message, at number 4"));
}

#[test]
fn a_missing_topic_lists_those_present_and_the_nearest() {
    let folder = folder();
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &day()));
    let (message, hint) = refusal(&path, &roll_by("/imv", "angle.roll"));
    let listed = "its topics are \"/imu\", \"/load\"";
    assert_eq!(message, format!("\"story.mcap\" has no topic \"/imv\" for roll; {listed}"));
    assert_eq!(hint, "did you mean \"/imu\"?");
    let mut given = roll_by("/imu", "angle.roll");
    given.channels[0].topic = None;
    let (message, hint) = refusal(&path, &given);
    assert_eq!(message, format!("no topic is given for roll in \"story.mcap\"; {listed}"));
    assert!(hint.contains("[columns]"), "{hint}");
}

#[test]
fn a_field_that_is_no_number_is_told_with_topic_and_message() {
    let folder = folder();
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &day()));
    let place = "\"story.mcap\" topic \"/imu\", message 1: field";
    let (message, hint) = refusal(&path, &roll_by("/imu", "angle.yaw"));
    assert_eq!(message, format!("{place} \"angle.yaw\" is not there"));
    assert!(hint.contains("\"angle.roll\""), "{hint}");
    let (message, _) = refusal(&path, &roll_by("/imu", "angle"));
    assert_eq!(message, format!("{place} \"angle\" is an object, not a number"));

    let messages = [("/imu", 0, "{\"roll\":NaN}".to_owned())];
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "json", &messages));
    let (message, _) = refusal(&path, &roll_by("/imu", "roll"));
    assert!(message.contains("field \"roll\" is unreadable, as the message is not JSON"));
}

#[test]
fn an_encoding_that_cannot_be_read_is_told() {
    let folder = folder();
    let path = write(&folder, "story.mcap", mcap_file(WriteOptions::new(), "cdr", &day()));
    let (message, hint) = refusal(&path, &roll_by("/imu", "angle.roll"));
    assert_eq!(message, "\"story.mcap\" topic \"/imu\" is encoded in \"cdr\", read is \"json\"");
    assert!(hint.contains("JSON"), "{hint}");
    assert!(play(&path, &Columns::default()).is_err(), "no channel is mapped");
}
