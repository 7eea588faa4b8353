//! The two measured decays of the KVLCC2 model are found in their recordings.

use std::path::PathBuf;

use devices::{Quantity, Sample};
use rolltank::run::{Event, Limits, Run, RunEnd, RunFinder, RunKind};

pub(crate) fn measured(file: &str) -> Option<Vec<Sample>> {
    let folder = std::env::var_os("ROLLTANK_MEASURED").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/measured"),
        PathBuf::from,
    );
    let path = folder.join("kvlcc2").join(file);
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: {} is not there; set ROLLTANK_MEASURED", path.display());
        return None;
    };
    let mut rows = text.lines();
    assert_eq!(rows.next(), Some("time,x,y,z,phi,theta,psi"));
    let sample = |row: &str| {
        let fields: Vec<f64> =
            row.split(',').map(|field| field.parse().expect("a number")).collect();
        Sample { quantity: Quantity::Roll, time_s: fields[0], value: fields[4] }
    };
    Some(rows.map(sample).collect())
}

fn find(samples: &[Sample], declared_speed_m_s: f64) -> Vec<Event> {
    let mut finder = RunFinder::new(Limits {
        carriage_max_speed_m_s: None,
        declared_speed_m_s: Some(declared_speed_m_s),
        length_pp_m: 4.70588,
        gravity_m_s2: 9.81,
    });
    let mut events = Vec::new();
    for sample in samples {
        finder.push(sample, &mut events);
    }
    finder.finish(&mut events);
    for event in &events {
        match event {
            Event::Run(run) => println!(
                "{:?} {:.2} to {:.2} s, {:?}, {} samples, still {:?}",
                run.kind,
                run.start_s,
                run.end_s,
                run.end,
                run.roll.time_s.len(),
                run.still
            ),
            Event::Aftermath(after) => println!("more after {:?} s", after.run_end_s),
            Event::Rejected(r) => println!("{:.2} to {:.2} s: {}", r.start_s, r.end_s, r.reason),
        }
    }
    events
}

fn only_run(events: &[Event]) -> &Run {
    let runs: Vec<&Run> = events
        .iter()
        .filter_map(|event| match event {
            Event::Run(run) => Some(run),
            Event::Rejected(_) | Event::Aftermath(_) => None,
        })
        .collect();
    assert_eq!(runs.len(), 1, "one decay per recording");
    runs[0]
}

#[test]
fn the_decay_at_rest_lasts_from_its_release_to_the_end_of_the_recording() {
    let Some(samples) = measured("model_test_21338.csv") else { return };
    let events = find(&samples, 0.0);
    let run = only_run(&events);
    assert_eq!((run.kind, run.end), (RunKind::Decay, RunEnd::RecordingEnded));
    // The first peak is at 8.07 s; the hand is on the model before it.
    assert!((8.0..8.3).contains(&run.start_s), "{}", run.start_s);
    assert!(run.end_s > 190.0, "{}", run.end_s);
    let still = run.still.unwrap();
    assert!(still.end_s < 7.5 && (still.roll_rad.to_degrees() + 0.015).abs() < 0.005);
}

#[test]
fn the_decay_at_speed_ends_before_the_model_is_stopped() {
    let Some(samples) = measured("model_test_21340.csv") else { return };
    let events = find(&samples, 0.9616);
    let run = only_run(&events);
    assert_eq!((run.kind, run.end), (RunKind::Decay, RunEnd::Caught));
    assert!((23.0..23.3).contains(&run.start_s), "{}", run.start_s);
    // The roll follows its decay until 77.9 s; the last half cycle before that is not trusted.
    assert!((74.0..77.0).contains(&run.end_s), "{}", run.end_s);
    let rest = events.iter().find_map(|event| match event {
        Event::Rejected(rest) if rest.start_s >= run.end_s => Some(rest),
        _ => None,
    });
    let rest = rest.expect("the rest of the recording is rejected");
    assert!(rest.reason.contains("stopped"), "{}", rest.reason);
    assert!(rest.end_s > 85.0, "{}", rest.end_s);
}
