//! Jitter, missing and repeated stamps, gaps, and recordings without a clock.

use devices::Quantity::{Roll, Speed};
use replay::Severity::{Lost, Mended};

use crate::recordings::{columns, folder, play_whole, refusal, table, write};

#[test]
fn jittered_stamps_are_kept_to_the_bit() {
    let folder = folder();
    let times = [0.0, 0.010_002_136_230_468_75, 0.020_001_411_437_988_28, 0.029_997];
    let text = table("t,roll", times.iter().map(|time_s| format!("{time_s:?},1")));
    let played = play_whole(&write(&folder, "story.csv", text), &columns(&[Roll]));
    let played_s: Vec<_> = played.samples.iter().map(|sample| sample.time_s).collect();
    assert_eq!(played_s, times);
    assert_eq!(played.notes, []);
}

#[test]
fn rows_without_a_stamp_are_placed_between_their_neighbours_and_told() {
    let folder = folder();
    let text = "t,roll\n1,10\n,11\n,12\n,13\n2,14\n2.5,15\n";
    let played = play_whole(&write(&folder, "story.csv", text), &columns(&[Roll]));
    let expected = [(1.0, 10.0), (1.25, 11.0), (1.5, 12.0), (1.75, 13.0), (2.0, 14.0), (2.5, 15.0)];
    assert_eq!(played.of(Roll), expected);
    assert!(played.note(Mended, "without a time stamp").contains("3 rows, the first at line 3"));
}

#[test]
fn stamps_of_a_clock_coarser_than_the_sampling_are_spread() {
    let folder = folder();
    let text = "t,roll\n1,10\n1,11\n1,12\n1,13\n2,14\n2,15\n";
    let played = play_whole(&write(&folder, "story.csv", text), &columns(&[Roll]));
    let expected = [(1.0, 10.0), (1.25, 11.0), (1.5, 12.0), (1.75, 13.0), (2.0, 14.0)];
    assert_eq!(played.of(Roll), expected);
    assert!(played.note(Mended, "repeating a time stamp").contains("4 rows, the first at line 3"));
    assert!(played.note(Lost, "left out").contains("1 row"), "the last has no later neighbour");
}

#[test]
fn an_empty_cell_is_a_missing_sample_of_its_channel_only() {
    let folder = folder();
    let text = "t,roll,speed\n0,1,5\n1,,6\n2,3,\n3,4,\n";
    let played = play_whole(&write(&folder, "story.csv", text), &columns(&[Roll, Speed]));
    assert_eq!(played.of(Roll), [(0.0, 1.0), (2.0, 3.0), (3.0, 4.0)]);
    assert_eq!(played.of(Speed), [(0.0, 5.0), (1.0, 6.0)]);
    assert!(played.note(Mended, "column \"roll\"").contains("1 empty cell, at line 3 of 4 rows"));
    assert!(played.note(Mended, "column \"speed\"").contains("2 empty cells, the first at line 4"));
}

#[test]
fn a_channel_that_is_empty_throughout_is_told_as_lost() {
    let folder = folder();
    let path = write(&folder, "story.csv", "t,roll,speed\n0,1,\n1,2,\n");
    let played = play_whole(&path, &columns(&[Roll, Speed]));
    assert_eq!(played.note(Lost, "speed"), "speed: the recording holds no sample");
}

#[test]
fn gaps_are_counted_with_the_longest_and_its_time() {
    let folder = folder();
    let times = (0..100).chain(400..500).chain(600..700);
    let text = table("t,roll", times.map(|index| format!("{},1", f64::from(index) / 100.0)));
    let played = play_whole(&write(&folder, "story.csv", text), &columns(&[Roll]));
    assert_eq!(
        played.note(Lost, "gap"),
        "roll: 2 gaps, 4.020 s without samples in all, the longest 3.010 s after 0.990 s"
    );
}

#[test]
fn a_recording_without_time_column_takes_the_sample_rate() {
    let folder = folder();
    let path = write(&folder, "story.csv", "roll\n1\n2\n3\n");
    let mut given = columns(&[Roll]);
    given.time = None;
    given.sample_rate_hz = Some(100.0);
    assert_eq!(play_whole(&path, &given).of(Roll), [(0.0, 1.0), (0.01, 2.0), (0.02, 3.0)]);

    given.sample_rate_hz = Some(-100.0);
    let (message, _) = refusal(&path, &given);
    assert_eq!(message, "sample rate -100 Hz, expected a positive number");

    given.sample_rate_hz = None;
    let (message, hint) = refusal(&path, &given);
    assert_eq!(
        message,
        "\"story.csv\" has no time: neither a time column nor a sample rate is given"
    );
    assert!(hint.contains("sample_rate_hz"), "{hint}");
}

#[test]
fn time_running_backwards_is_refused_with_line_and_both_times() {
    let folder = folder();
    let path = write(&folder, "story.csv", "t,roll\r\n0,1\r\n0.5,2\r\n\r\n0.25,3\r\n");
    let (message, hint) = refusal(&path, &columns(&[Roll]));
    assert_eq!(message, "\"story.csv\" line 5: time runs backwards, 0.25 s after 0.5 s");
    assert!(hint.contains("cut the file"), "{hint}");
}

#[test]
fn a_time_column_without_stamps_is_refused() {
    let folder = folder();
    let path = write(&folder, "story.csv", "t,roll\n,1\n,2\n");
    let (message, hint) = refusal(&path, &columns(&[Roll]));
    assert_eq!(message, "\"story.csv\" has no time stamp in any of its 2 rows");
    assert!(hint.contains("sample_rate_hz"), "{hint}");

    let rows = "0,1\n".repeat(70_000);
    let path = write(&folder, "story.csv", format!("t,roll\n{rows}"));
    let (message, _) = refusal(&path, &columns(&[Roll]));
    assert!(message.contains("65536 rows in a row without a time stamp of their own"), "{message}");
}
