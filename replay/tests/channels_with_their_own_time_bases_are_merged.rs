//! One file per channel, or one time column per channel, come out as one stream in time order.

use devices::Quantity::{Force, Roll, Speed};
use devices::{Device, Reading};
use replay::Player;

use crate::recordings::{columns, folder, play_files, play_whole, table, time, write};

/// Rows of `t,NAME` at a rate, the value being the time.
fn rows(name: &str, rate_hz: u32, seconds: u32, shift_s: f64) -> String {
    let rows = (0..rate_hz * seconds).map(|index| {
        let time_s = f64::from(index) / f64::from(rate_hz) + shift_s;
        format!("{time_s:?},{time_s:?}")
    });
    table(&format!("t,{name}"), rows)
}

#[test]
fn channels_in_separate_files_with_their_own_rates_are_merged_in_time_order() {
    let folder = folder();
    let files = [
        (Some(Speed), write(&folder, "speed.csv", rows("speed", 10, 20, 0.05))),
        (Some(Roll), write(&folder, "roll.csv", rows("roll", 100, 20, 0.0))),
        (Some(Force), write(&folder, "force.csv", rows("force", 200, 20, 0.0))),
    ];
    let played = play_files(&files, &columns(&[Roll, Force, Speed])).expect("it opens");
    assert_eq!(played.samples.len(), 200 + 2000 + 4000);
    let sorted =
        played.samples.is_sorted_by(|a, b| (a.time_s, a.quantity) < (b.time_s, b.quantity));
    assert!(sorted, "time first, then the order of the quantities");
    assert!(played.samples.iter().all(|sample| sample.time_s.to_bits() == sample.value.to_bits()));
    assert_eq!(played.notes, []);
}

#[test]
fn each_channel_may_have_its_own_time_column_in_one_file() {
    let folder = folder();
    // Force is sampled half as often, so its last stamp is twice as late: far apart in the file,
    // near in time.
    let rows = (0..5000).map(|index| {
        let time_s = f64::from(index) / 100.0;
        format!("{time_s:?},1,{:?},2", 2.0 * time_s)
    });
    let text = table("t_roll,roll,t_force,force", rows);
    let mut given = columns(&[Roll, Force]);
    given.time = Some(time("t_roll"));
    given.channels[1].time = Some(time("t_force"));
    let played = play_whole(&write(&folder, "story.csv", text), &given);
    assert!(played.samples.is_sorted_by(|a, b| (a.time_s, a.quantity) < (b.time_s, b.quantity)));
    assert_eq!(played.of(Roll).len(), 5000);
    assert_eq!(played.of(Force).last(), Some(&(99.98, 2.0)));
}

#[test]
fn a_file_per_channel_is_read_for_its_channel_only() {
    let folder = folder();
    let both = write(&folder, "both.csv", "t,roll,speed\n0,1,2\n1,3,4\n");
    let given = columns(&[Roll, Speed]);
    let played = play_files(&[(Some(Speed), both.clone())], &given).expect("it opens");
    assert_eq!(played.of(Speed), [(0.0, 2.0), (1.0, 4.0)]);
    assert_eq!(played.of(Roll), []);

    let error = play_files(&[(None, both.clone()), (Some(Roll), both)], &given);
    let error = error.expect_err("roll would come twice");
    assert_eq!(error.to_string(), "recording \"story\" holds roll twice");
    let error = play_files(&[], &given).expect_err("no file");
    assert_eq!(error.to_string(), "recording \"story\" names no file");
}

#[test]
fn a_player_is_a_device_and_tells_its_progress_and_its_own_error() {
    let folder = folder();
    let mut text = rows("roll", 100, 100, 0.0);
    text += "200,oops\n";
    let path = write(&folder, "story.csv", &text);
    let mut player = Player::open("pass 1", &[(None, path)], &columns(&[Roll])).expect("it opens");
    let device: &mut dyn Device = &mut player;
    assert_eq!(device.name(), "pass 1");
    let mut samples = Vec::new();
    let error = loop {
        match device.read(&mut samples) {
            Ok(reading) => assert_eq!(reading, Reading::More),
            Err(error) => break error,
        }
    };
    assert_eq!(samples.len(), 10_000);
    assert_eq!(error.to_string(), "\"pass 1\"");
    let source = error.source.downcast_ref::<replay::ReplayError>().expect("our error");
    assert!(source.hint().is_some());
    assert_eq!(player.progress(), (text.len() as u64, text.len() as u64));
}
