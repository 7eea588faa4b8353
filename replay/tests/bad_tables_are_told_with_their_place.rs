//! Every mistake in a table names file, line, column, value and what to do.

use devices::Quantity::{Force, Roll};

use crate::recordings::{columns, folder, play, play_whole, refusal, write};
use replay::Severity::Lost;

fn refused(text: impl AsRef<[u8]>) -> (String, String) {
    let folder = folder();
    refusal(&write(&folder, "story.csv", text), &columns(&[Roll]))
}

#[test]
fn a_missing_file_is_told() {
    let folder = folder();
    let (message, hint) = refusal(&folder.path().join("story.csv"), &columns(&[Roll]));
    assert_eq!(message, "\"story.csv\" cannot be opened");
    assert!(hint.contains("check the path"), "{hint}");
}

#[test]
fn an_empty_file_and_a_lone_header_are_told() {
    assert_eq!(refused("").0, "\"story.csv\" is empty (0 bytes)");
    assert_eq!(refused("t,roll\n").0, "\"story.csv\" has a header but no row of numbers");
    assert_eq!(refused("t,roll").0, "\"story.csv\" has a header but no row of numbers");
    let folder = folder();
    let (message, _) = refusal(&write(&folder, "story.mcap", ""), &columns(&[Roll]));
    assert_eq!(message, "\"story.mcap\" is empty (0 bytes)");
}

#[test]
fn a_header_with_units_but_no_numbers_is_told() {
    let (message, _) = refused("t,roll\n[s],[deg]\n");
    assert_eq!(message, "\"story.csv\" has a header but no row of numbers");
}

#[test]
fn a_missing_column_lists_those_present_and_the_nearest() {
    let (message, hint) = refused("t;Rol;force\n0;1;2\n");
    assert_eq!(
        message,
        "\"story.csv\" has no column \"roll\" for roll; its columns are \"t\", \"Rol\", \"force\""
    );
    assert_eq!(hint, "did you mean \"Rol\"?");
    let (message, _) = refused("zeit,roll\n0,1\n");
    assert!(message.starts_with("\"story.csv\" has no column \"t\" for time"), "{message}");
}

#[test]
fn a_column_named_twice_is_told() {
    let (message, _) = refused("t,roll,roll\n0,1,2\n");
    assert_eq!(message, "\"story.csv\" has 2 columns named \"roll\"");
}

#[test]
fn a_cell_that_is_no_finite_number_is_told_with_its_text() {
    for (cell, fault) in [
        ("NaN", "not a finite number"),
        ("inf", "not a finite number"),
        ("1e999", "not a finite number"),
        ("n/a", "not a number"),
        ("1.2.3", "not a number"),
    ] {
        let (message, hint) = refused(format!("t,roll\r\n0,1\r\n1,2\r\n2,{cell}\r\n3,4\r\n"));
        let place = "\"story.csv\" line 4, column \"roll\"";
        assert_eq!(message, format!("{place}: \"{cell}\" is {fault}"));
        assert!(!hint.is_empty());
    }
    let (message, _) = refused("t,roll\n0,1\nnoon,2\n");
    assert_eq!(message, "\"story.csv\" line 3, column \"t\": \"noon\" is not a number");
}

#[test]
fn a_bad_first_row_is_no_line_of_units() {
    let (message, _) = refused("t,roll\nNaN,1\n1,2\n");
    assert_eq!(message, "\"story.csv\" line 2, column \"t\": \"NaN\" is not a finite number");
}

#[test]
fn thousands_marks_are_not_taken_for_decimal_signs() {
    let (message, hint) = refused("t,roll\n0,\"1,234\"\n");
    assert!(message.contains("line 2, column \"roll\": \"1,234\""), "{message}");
    assert!(hint.contains("thousands"), "{hint}");
    let (message, hint) = refused("t;roll\n0,5;1\n1.5;1\n");
    assert!(message.contains("line 3, column \"t\": \"1.5\" is written with the other"));
    assert!(hint.contains("decimal point and the decimal comma"), "{hint}");
}

#[test]
fn a_row_of_another_length_is_told_and_a_torn_last_line_is_lost() {
    let (message, _) = refused("t,roll\n0,1\n1\n2,3\n");
    assert_eq!(message, "\"story.csv\" line 3 has 1 cells, expected 2");
    let (message, _) = refused("t,roll\n0,1\n1,2,3\n2,3\n");
    assert_eq!(message, "\"story.csv\" line 3 has 3 cells, expected 2");

    let folder = folder();
    let played = play_whole(&write(&folder, "story.csv", "t,roll\n0,1\n1"), &columns(&[Roll]));
    assert_eq!(played.of(Roll), [(0.0, 1.0)]);
    assert!(played.note(Lost, "cut short").contains("the last line, 3,"));
}

#[test]
fn what_was_read_before_a_mistake_is_delivered() {
    let folder = folder();
    let path = write(&folder, "story.csv", "t,roll\n0,1\n1,2\n2,x\n");
    let played = play(&path, &columns(&[Roll])).expect("it opens");
    assert_eq!(played.of(Roll), [(0.0, 1.0), (1.0, 2.0)]);
    assert!(played.error.is_some());
}

#[test]
fn a_quote_that_is_never_closed_does_not_swallow_the_file() {
    let rows = "1,2\n".repeat(600_000);
    let (message, hint) = refused(format!("t,roll\n0,1\n1,\"2\n{rows}"));
    assert_eq!(message, "\"story.csv\" line 3 is longer than 1048576 bytes");
    assert!(hint.contains("quote"), "{hint}");
}

#[test]
fn text_in_utf16_and_files_that_are_no_mcap_are_told() {
    let (message, hint) = refused(b"\xff\xfet\0,\0r\0");
    assert_eq!(message, "\"story.csv\" is text in UTF-16, read are UTF-8 and Latin-1");
    assert_eq!(hint, "save the table as UTF-8");
    let folder = folder();
    let path = write(&folder, "story.mcap", "t,roll\n0,1\n");
    let (message, _) = refusal(&path, &columns(&[Roll]));
    assert!(message.starts_with("\"story.mcap\" is not an MCAP file"), "{message}");
}

#[test]
fn a_file_for_a_channel_without_column_is_told() {
    let folder = folder();
    let path = write(&folder, "story.csv", "t,roll\n0,1\n");
    let files = [(Some(Force), path)];
    let error = crate::recordings::play_files(&files, &columns(&[Roll])).expect_err("no column");
    let (message, hint) = crate::recordings::told(&error);
    assert_eq!(message, "\"story.csv\" is to hold force, but no column is given for force");
    assert_eq!(hint, "add force to [columns] of the campaign file");
}
