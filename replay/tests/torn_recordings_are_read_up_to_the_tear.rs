//! Recordings cut short by a crash, a full disk or a pulled stick.

use devices::Quantity::Roll;
use devices::Sample;
use mcap::WriteOptions;
use replay::Severity::Lost;
use replay::{Columns, Exit, Provenance, Recorder};

use crate::foreign_mcap_recordings_are_read_by_topic_and_field::mcap_file;
use crate::recordings::{Played, channel, folder, play, play_whole, refusal, write};

/// One of our recordings: 20 000 samples, in several chunks.
fn recorded() -> Vec<u8> {
    let folder = folder();
    let target = folder.path().join("whole.mcap");
    let mut recorder = Recorder::create(&target, &Provenance::default()).expect("it starts");
    for index in 0..20_000 {
        let time_s = f64::from(index) / 100.0;
        let value = (2.4 * time_s).sin();
        recorder.push(Sample { quantity: Roll, time_s, value }).expect("it is recorded");
    }
    recorder.finish(Exit::success("story")).expect("it is completed");
    std::fs::read(target).expect("it is there")
}

#[track_caller]
fn torn(bytes: &[u8]) -> Played {
    let folder = folder();
    let played = play_whole(&write(&folder, "story.mcap", bytes), &Columns::default());
    let note = played.note(Lost, "torn at byte");
    assert!(note.contains(&format!("of {}, ", bytes.len())), "{note}");
    assert!(note.contains("hint: `mcap recover`"), "{note}");
    played
}

#[test]
fn what_came_before_the_tear_is_delivered_and_the_tear_is_told() {
    let bytes = recorded();
    let folder = folder();
    let whole = play_whole(&write(&folder, "story.mcap", &bytes), &Columns::default());
    assert_eq!(whole.samples.len(), 20_000);
    assert_eq!(whole.notes, []);
    let mut before = 20_001;
    for part in [99, 80, 60, 40, 20] {
        let played = torn(&bytes[..bytes.len() * part / 100]);
        assert_eq!(played.samples, whole.samples[..played.samples.len()], "to the bit");
        assert!(played.samples.len() < before, "{part} % holds less than more of the file");
        // The summary at the end holds no samples; a tear loses a block of the torn chunk.
        assert!(played.samples.len() + 6000 > 200 * part, "{} of {part} %", played.samples.len());
        before = played.samples.len();
    }
}

#[test]
fn a_tear_in_the_summary_loses_no_sample() {
    let bytes = recorded();
    for missing in [1, 8, 30, 100] {
        let folder = folder();
        let path = write(&folder, "story.mcap", &bytes[..bytes.len() - missing]);
        assert_eq!(play_whole(&path, &Columns::default()).samples.len(), 20_000);
    }
}

#[test]
fn a_damaged_summary_loses_no_sample() {
    let mut bytes = recorded();
    let footer = bytes.len() - 37;
    assert_eq!(bytes[footer], mcap::records::op::FOOTER);
    let start: [u8; 8] = bytes[footer + 9..footer + 17].try_into().expect("eight bytes");
    // The first record of the summary gets a length that leads nowhere.
    bytes[u64::from_le_bytes(start) as usize + 3] = 0xff;
    let folder = folder();
    let played = play_whole(&write(&folder, "story.mcap", &bytes), &Columns::default());
    assert_eq!(played.samples.len(), 20_000);
}

#[test]
fn a_tail_of_zeros_is_a_tear() {
    let mut bytes = recorded();
    bytes.truncate(bytes.len() / 2);
    let kept = torn(&bytes).samples.len();
    let folder = folder();
    let messages: Vec<_> =
        (0..50).map(|index| ("/roll", index * 1_000_000, format!("{{\"r\":{index}}}"))).collect();
    let mut plain = mcap_file(WriteOptions::new().use_chunks(false), "json", &messages);
    let end =
        plain.windows(9).position(|bytes| bytes == b"{\"r\":30}\x05").expect("message 30") + 8;
    plain.truncate(end);
    plain.extend([0; 4096]);
    let mut roll = channel(Roll, "r");
    roll.topic = Some("/roll".to_owned());
    let given = Columns { channels: vec![roll], ..Columns::default() };
    let played = play_whole(&write(&folder, "story.mcap", plain), &given);
    assert_eq!(played.samples.len(), 31);
    assert!(played.note(Lost, "torn").contains(&format!("torn at byte {end} of")));
    assert!(kept > 0);
}

#[test]
fn a_chunk_that_was_never_closed_is_read_as_far_as_it_was_written() {
    // A killed writer leaves the lengths of its last chunk open, as the largest number there is.
    let mut bytes = recorded();
    let chunk = last_chunk(&bytes);
    bytes.truncate(chunk + (bytes.len() - chunk) / 2);
    let closed = torn(&bytes).samples.len();
    let compressed_size = chunk + 9 + 32 + "zstd".len();
    bytes[chunk + 1..chunk + 9].fill(0xff);
    bytes[chunk + 9 + 16..chunk + 9 + 24].fill(0xff);
    bytes[compressed_size..compressed_size + 8].fill(0xff);
    let open = torn(&bytes).samples.len();
    assert_eq!(open, closed);
    assert!(open > 0);
}

/// Byte at which the last chunk begins, by walking the records.
fn last_chunk(bytes: &[u8]) -> usize {
    let (mut at, mut last) = (8, 0);
    while at + 9 <= bytes.len() && bytes[at] != mcap::records::op::DATA_END {
        if bytes[at] == mcap::records::op::CHUNK {
            last = at;
        }
        let length: [u8; 8] = bytes[at + 1..at + 9].try_into().expect("eight bytes");
        at += 9 + u64::from_le_bytes(length) as usize;
    }
    last
}

#[test]
fn a_file_that_was_torn_at_once_is_told() {
    let bytes = recorded();
    let folder = folder();
    let path = write(&folder, "story.mcap", &bytes[..5]);
    assert!(refusal(&path, &Columns::default()).0.contains("is not an MCAP file"));
    let path = write(&folder, "story.mcap", &bytes[..20]);
    let (message, _) = refusal(&path, &Columns::default());
    assert_eq!(message, "\"story.mcap\" holds no message");
}

#[test]
fn a_flipped_bit_is_never_taken_for_a_sample() {
    let mut bytes = recorded();
    let folder = folder();
    let whole = play_whole(&write(&folder, "story.mcap", &bytes), &Columns::default());
    let middle = last_chunk(&bytes) + 2000;
    bytes[middle] ^= 0x10;
    let path = write(&folder, "story.mcap", &bytes);
    let played = play(&path, &Columns::default()).expect("it opens");
    let error = played.error.expect("the chunk's checksum is wrong");
    assert!(error.to_string().contains("is damaged in the record at byte"), "{error}");
    assert!(error.hint().expect("a hint").contains("copy the file from its source"));
    assert!(played.samples.len() < whole.samples.len());
    assert!(played.samples.len() > 10_000, "the chunks before are read");
    assert_eq!(played.samples, whole.samples[..played.samples.len()]);
}
