//! Public measured recordings, when their folder is on the machine.

use std::env;
use std::path::PathBuf;

use devices::Quantity::{Force, Roll};
use replay::Columns;
use replay::Severity::Lost;

use crate::recordings::{channel, play_whole, time};

/// A file among the measured recordings; none, and a line that says so, without them.
fn measured(name: &str) -> Option<PathBuf> {
    let workspace = concat!(env!("CARGO_MANIFEST_DIR"), "/../");
    let folder = env::var_os("ROLLTANK_MEASURED").unwrap_or("../shared/measured".into());
    let path = PathBuf::from(workspace).join(folder).join(name);
    if path.is_file() {
        return Some(path);
    }
    eprintln!("skipped: no measured recordings at {} (set ROLLTANK_MEASURED)", path.display());
    None
}

#[test]
fn the_decays_of_the_kvlcc2_come_whole_with_their_jitter() {
    let given = Columns {
        time: Some(time("time")),
        sample_rate_hz: None,
        channels: vec![channel(Roll, "phi")],
    };
    for (name, rows, last_s) in [
        ("kvlcc2/model_test_21338.csv", 19_464, 194.629_996_299_743_65),
        ("kvlcc2/model_test_21340.csv", 8782, 87.809_988_975_524_9),
    ] {
        let Some(path) = measured(name) else { return };
        let played = play_whole(&path, &given);
        assert_eq!(played.samples.len(), rows);
        assert_eq!(played.samples.last().map(|sample| sample.time_s), Some(last_s));
        assert!(played.notes.iter().all(|note| note.severity != Lost), "{:?}", played.notes);
    }
}

#[test]
fn the_ship_section_of_ntnu_comes_with_its_many_channels() {
    let Some(path) = measured("ntnu_section/6061_1.csv") else { return };
    let given = Columns {
        time: Some(time("Time [s]")),
        sample_rate_hz: None,
        channels: vec![channel(Force, "Force_Sway [N]"), channel(Roll, "Roll [rad]")],
    };
    let played = play_whole(&path, &given);
    assert_eq!(played.of(Roll).len(), 12_349);
    assert_eq!(played.of(Force).len(), 12_349);
    assert_eq!(played.of(Roll)[0], (0.0, -0.000_213_367_495_543_297_27));
    assert_eq!(played.notes, []);
}
