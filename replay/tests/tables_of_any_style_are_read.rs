//! Delimiters, decimal signs, line ends, byte order marks, headers and units lines.

use devices::Quantity::{Force, Roll, Speed};
use proptest::prelude::*;

use crate::recordings::{channel, columns, folder, play_whole, time, write};
use replay::Columns;

const EXPECTED: [(f64, f64); 3] = [(0.0, 1.5), (0.01, -2.25e-3), (0.02, 7.0)];

fn reads_alike(text: &[u8]) {
    let folder = folder();
    let path = write(&folder, "story.csv", text);
    let played = play_whole(&path, &columns(&[Roll]));
    assert_eq!(played.of(Roll), EXPECTED, "{}", String::from_utf8_lossy(text));
    assert_eq!(played.notes, [], "nothing to mend");
}

#[test]
fn comma_semicolon_and_tab_part_the_cells() {
    reads_alike(b"t,roll\n0,1.5\n0.01,-2.25e-3\n0.02,7\n");
    reads_alike(b"t;roll\n0;1.5\n0.01;-2.25e-3\n0.02;7\n");
    reads_alike(b"t\troll\n0\t1.5\n0.01\t-2.25e-3\n0.02\t7\n");
}

#[test]
fn a_decimal_comma_is_read_where_cells_are_not_parted_by_commas() {
    reads_alike(b"t;roll\n0,0;1,5\n0,01;-2,25E-3\n0,02;7\n");
    reads_alike(b"t\troll\n0\t1,5\n0,01\t-2,25e-3\n0,02\t7,000\n");
}

#[test]
fn byte_order_mark_line_ends_blanks_and_blank_lines_do_not_matter() {
    reads_alike(b"\xef\xbb\xbft,roll\r\n0,1.5\r\n0.01,-2.25e-3\r\n0.02,7\r\n");
    reads_alike(b"t, roll \n 0 , 1.5\n\n0.01,\t-2.25e-3\n0.02,7");
    reads_alike(b"t,roll,\n0,1.5,\n0.01,-2.25e-3,\n  \n0.02,7,\n");
}

#[test]
fn quoted_headers_and_cells_are_read() {
    reads_alike(b"\"t\",\"roll\"\n\"0\",\"1.5\"\n0.01,-2.25e-3\n0.02,7\n");
}

#[test]
fn a_line_of_units_or_comments_after_the_header_is_passed_over() {
    reads_alike(b"t,roll\n[s],[rad]\n0,1.5\n0.01,-2.25e-3\n0.02,7\n");
    reads_alike(b"t;roll;note\ns;;\n0;1.5;calm\n0.01;-2.25e-3;\n0.02;7;\n");
}

#[test]
fn headers_are_matched_exactly_as_spelled_in_any_encoding() {
    let folder = folder();
    let given = Columns {
        time: Some(time("Zeit, s")),
        sample_rate_hz: None,
        channels: vec![channel(Roll, "Roll [\u{b0}]"), channel(Speed, "v (m/s)")],
    };
    let utf8 = "roll [\u{b0}],\"Zeit, s\",Roll [\u{b0}],v (m/s)\n9,0,1,2\n9,1,3,4\n";
    let latin1: Vec<u8> = utf8.chars().map(|letter| letter as u8).collect();
    for text in [utf8.as_bytes(), &latin1] {
        let played = play_whole(&write(&folder, "story.csv", text), &given);
        assert_eq!(played.of(Roll), [(0.0, 1.0), (1.0, 3.0)]);
        assert_eq!(played.of(Speed), [(0.0, 2.0), (1.0, 4.0)]);
    }
}

#[test]
fn units_become_si_and_channels_of_a_row_come_in_one_order() {
    let folder = folder();
    let path = write(&folder, "story.csv", "speed,force,roll,t\n2,30,180,1000\n4,40,90,2000\n");
    let mut given = columns(&[Speed, Roll, Force]);
    given.time.as_mut().expect("there is a time column").seconds_per_unit = 1e-3;
    given.channels[1].si_per_unit = std::f64::consts::PI / 180.0;
    let played = play_whole(&path, &given);
    let order: Vec<_> = played.samples.iter().map(|sample| sample.quantity).collect();
    assert_eq!(order, [Roll, Force, Speed, Roll, Force, Speed]);
    assert_eq!(played.of(Roll)[0], (1.0, std::f64::consts::PI));
    assert_eq!(played.of(Speed)[1], (2.0, 4.0));
}

proptest! {
    #[test]
    fn a_table_written_in_any_style_reads_back_to_the_bit(
        rows in prop::collection::vec((1e-6..1e3_f64, any::<f64>(), any::<f64>()), 1..50),
        delimiter in prop::sample::select(vec![',', ';', '\t']),
        comma in any::<bool>(),
        line_end in prop::sample::select(vec!["\n", "\r\n"]),
        quoted in any::<bool>(),
        mark in any::<bool>(),
    ) {
        let comma = comma && delimiter != ',';
        let mut text = String::from(if mark { "\u{feff}" } else { "" });
        text += &["t", "roll", "speed"].join(&delimiter.to_string());
        let mut expected = (Vec::new(), Vec::new());
        let mut time_s = 0.0;
        for (step_s, roll, speed) in rows {
            time_s += step_s;
            prop_assume!(roll.is_finite() && speed.is_finite());
            expected.0.push((time_s, roll));
            expected.1.push((time_s, speed));
            let cells = [time_s, roll, speed].map(|number| {
                let mut cell = format!("{number:?}");
                if comma { cell = cell.replace('.', ","); }
                if quoted { format!("\"{cell}\"") } else { cell }
            });
            text += line_end;
            text += &cells.join(&delimiter.to_string());
        }
        let folder = folder();
        let played = play_whole(&write(&folder, "story.csv", text), &columns(&[Roll, Speed]));
        prop_assert_eq!(played.of(Roll), expected.0);
        prop_assert_eq!(played.of(Speed), expected.1);
    }
}
