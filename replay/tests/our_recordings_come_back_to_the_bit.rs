//! What the recorder writes and what an import makes of any recording plays back exactly.

use std::fs;

use devices::Quantity::{Force, Moment, Roll, Speed};
use devices::{Quantity, Sample};
use proptest::prelude::*;
use replay::{Columns, Exit, Provenance, Recorder, Severity, import};

use crate::recordings::{columns, folder, play_files, play_whole, table, time, write};

fn sample(quantity: Quantity, time_s: f64, value: f64) -> Sample {
    Sample { quantity, time_s, value }
}

#[test]
fn an_imported_table_plays_back_with_exactly_its_own_samples() {
    let folder = folder();
    let rows = (0..5000).map(|index| {
        let time_s = f64::from(index) / 100.0 + 1e-5 * f64::from(index % 7) - 3.7;
        let roll = (0.7 * time_s).sin() / 3.0;
        format!("{time_s:?};{roll:?};{}", if index % 10 == 0 { "1.1" } else { "" })
    });
    let path = write(&folder, "pass.csv", table("t;roll;speed", rows));
    let target = folder.path().join("pass.mcap");
    let mut told = Vec::new();
    let given = columns(&[Roll, Speed]);
    let files = [(None, path.clone())];
    let report = import("pass.csv", &files, &given, &target, "name = \"x\"", &mut |read, total| {
        told.push((read, total));
    });
    let report = report.expect("the import succeeds");
    assert_eq!(report.samples, [(Roll, 5000), (Speed, 500)]);
    assert_eq!((report.first_s, report.last_s), (-3.7, 4999.0 / 100.0 + 1e-5 - 3.7));
    assert_eq!(report.notes.len(), 1, "the empty speed cells: {:?}", report.notes);
    assert_eq!(report.notes[0].severity, Severity::Mended);
    assert!(told.is_sorted() && told.len() == 6, "once a batch: {told:?}");
    assert_eq!(told.last().map(|told| told.0), told.last().map(|told| told.1));

    let imported = play_whole(&target, &Columns::default());
    assert_eq!(imported.samples, play_whole(&path, &given).samples);
    assert_eq!(imported.notes, []);
    let roll = play_files(&[(Some(Roll), target.clone())], &Columns::default()).expect("opens");
    assert_eq!(roll.samples.len(), 5000);
    let error = play_files(&[(Some(Force), target)], &Columns::default()).expect_err("no force");
    assert!(error.to_string().contains("has no topic \"/force\" for force"), "{error}");
    assert!(error.to_string().ends_with("its topics are \"/roll\", \"/speed\""), "{error}");
}

#[test]
fn an_import_merges_files_and_can_itself_be_imported() {
    let folder = folder();
    let files = [
        (Some(Force), write(&folder, "force.csv", "t_f,force\n0.5,3\n1.5,4\n")),
        (Some(Roll), write(&folder, "roll.csv", "t,roll\n0.5,1\n1,2\n")),
    ];
    let mut given = columns(&[Roll, Force]);
    given.channels[1].time = Some(time("t_f"));
    let (once, twice) = (folder.path().join("once.mcap"), folder.path().join("twice.mcap"));
    import("pass", &files, &given, &once, "", &mut |_, _| {}).expect("tables are imported");
    import("pass", &[(None, once.clone())], &given, &twice, "", &mut |_, _| {})
        .expect("our own recording is imported");
    let expected = [
        sample(Roll, 0.5, 1.0),
        sample(Force, 0.5, 3.0),
        sample(Roll, 1.0, 2.0),
        sample(Force, 1.5, 4.0),
    ];
    assert_eq!(play_whole(&once, &given).samples, expected);
    assert_eq!(play_whole(&twice, &given).samples, expected);
}

#[test]
fn a_recording_says_where_it_comes_from() {
    let folder = folder();
    let path = write(&folder, "pass.csv", "t,roll\n-0.25,1\n0,2\n");
    let target = folder.path().join("pass.mcap");
    let campaign = "name = \"OE basin\"\n";
    import("pass.csv", &[(None, path)], &columns(&[Roll]), &target, campaign, &mut |_, _| {})
        .expect("the import succeeds");
    let bytes = fs::read(&target).expect("it is there");
    let summary = mcap::Summary::read(&bytes).expect("it is whole").expect("it has a summary");
    assert_eq!(summary.metadata_indexes.len(), 1);
    let index = &summary.metadata_indexes[0];
    assert_eq!(index.name, "rolltank");
    let metadata = mcap::read::metadata(&bytes, index).expect("it can be read").metadata;
    assert_eq!(metadata["campaign"], campaign);
    assert_eq!(metadata["source"], "pass.csv\npass.csv");
    assert_eq!(metadata["zero_log_time_ns"], "1000000000", "log times cannot be negative");
    let logged: Vec<_> = mcap::MessageStream::new(&bytes)
        .expect("it can be streamed")
        .map(|message| message.expect("it is whole"))
        .map(|message| (message.log_time, message.publish_time, message.sequence))
        .collect();
    assert_eq!(logged, [(750_000_000, 750_000_000, 0), (1_000_000_000, 1_000_000_000, 1)]);
}

#[test]
fn what_cannot_be_recorded_is_refused_with_its_value() {
    let folder = folder();
    let target = folder.path().join("pass.mcap");
    let mut recorder = Recorder::create(&target, &Provenance::default()).expect("it starts");
    let refused = |recorder: &mut Recorder, time_s, value| {
        recorder.push(sample(Roll, time_s, value)).expect_err("it is refused").to_string()
    };
    let message = refused(&mut recorder, 1.0, f64::NAN);
    assert_eq!(message, "roll NaN at 1 s cannot be recorded: value and time must be finite");
    assert!(refused(&mut recorder, f64::INFINITY, 0.0).contains("must be finite"));
    assert!(refused(&mut recorder, -1.0, 0.0).contains("log time must be 0 to 18.4e9 s"));
    assert!(refused(&mut recorder, 1e11, 0.0).contains("log time must be 0 to 18.4e9 s"));
    recorder.push(sample(Roll, 2.0, 0.5)).expect("a good sample");
    assert!(refused(&mut recorder, 1.0, 0.5).contains("channel roll: time runs backwards, 1 s"));
    let finished = recorder.finish(Exit::success("story")).expect("it is completed");
    assert_eq!(finished.samples, [(Roll, 1)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_recorded_samples_read_back_to_the_bit(
        rows in prop::collection::vec((0..4_usize, 1e-9..1e3_f64, any::<f64>()), 1..400),
    ) {
        let mut time_s = 0.0;
        let mut samples = Vec::new();
        for (quantity, step_s, value) in rows {
            time_s += step_s;
            if value.is_finite() {
                samples.push(sample([Roll, Force, Moment, Speed][quantity], time_s, value));
            }
        }
        prop_assume!(!samples.is_empty());
        let folder = folder();
        let target = folder.path().join("pass.mcap");
        let mut recorder = Recorder::create(&target, &Provenance::default()).expect("it starts");
        for sample in &samples {
            recorder.push(sample).expect("it is recorded");
        }
        recorder.finish(Exit::success("story")).expect("it is completed");
        let played = play_whole(&target, &Columns::default());
        let bits = |samples: &[Sample]| -> Vec<_> {
            let numbers = samples.iter().map(|sample| (sample.time_s, sample.value));
            let bits = numbers.map(|(time_s, value)| (time_s.to_bits(), value.to_bits()));
            samples.iter().map(|sample| sample.quantity).zip(bits).collect()
        };
        prop_assert_eq!(bits(&played.samples), bits(&samples));
    }
}
