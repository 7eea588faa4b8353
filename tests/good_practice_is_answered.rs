//! The gates of the ITTC procedure: met, missed with the number, or not to be told.

use rolltank::campaign::Campaign;
use rolltank::procedure::{self, Answer};
use rolltank::results::{IdentifiedRun, Results, Sampling};
use rolltank::run::{RunKind, Still};
use serde_json::Value;

use crate::campaign_folder::{CampaignFolder, rolltank};
use crate::synthetic_results;

fn first(kind: RunKind) -> IdentifiedRun {
    let mut runs = synthetic_results::results().runs.into_iter();
    runs.find(|run| run.run.kind == kind).expect("a run of each kind")
}

fn answer(run: &IdentifiedRun, id: &str) -> Answer {
    let mut answers = procedure::of_run(&synthetic_results::campaign("OE basin"), run).into_iter();
    answers.find(|answer| answer.gate.id == id).unwrap_or_else(|| panic!("no gate {id}"))
}

#[track_caller]
fn assert_answered(run: &IdentifiedRun, id: &str, met: Option<bool>, value: Option<f64>) {
    let answer = answer(run, id);
    assert_eq!(answer.met, met, "{answer:?}");
    match value {
        None => assert_eq!(answer.value, None, "{answer:?}"),
        Some(value) => {
            let found = answer.value.expect("a value");
            assert!((found - value).abs() <= 0.02 * value, "{answer:?}");
        }
    }
}

fn still(duration_s: f64, roll_sd_rad: f64) -> Still {
    Still { start_s: 10.0, end_s: 10.0 + duration_s, roll_rad: 0.0, roll_sd_rad, force: None }
}

#[test]
fn a_decay_is_asked_for_rest_peaks_small_cycles_its_end_and_its_sampling() {
    let mut run = first(RunKind::Decay);
    let campaign = synthetic_results::campaign("OE basin");
    let answers = procedure::of_run(&campaign, &run);
    let asked: Vec<&str> = answers.iter().map(|answer| answer.gate.id).collect();
    let of_a_decay = [
        "rest-before-release",
        "settled",
        "sampling",
        "peaks",
        "small-cycles",
        "down-to-half-a-degree",
        "before-waves-return",
    ];
    assert_eq!(asked, of_a_decay);

    run.run.still = Some(still(4.0, 0.0));
    assert_answered(&run, "rest-before-release", Some(true), Some(4.0));
    run.run.still = Some(still(0.5, 0.0));
    assert_answered(&run, "rest-before-release", Some(false), Some(0.5));
    run.run.still = None;
    assert_answered(&run, "rest-before-release", Some(false), None);
    assert_answered(&run, "settled", None, None);

    run.sampling = Sampling { roll_hz: Some(40.0), drive_hz: None };
    assert_answered(&run, "sampling", Some(false), Some(40.0));
    run.sampling = Sampling { roll_hz: Some(100.0), drive_hz: Some(10.0) };
    assert_answered(&run, "sampling", Some(true), Some(100.0));
    run.sampling = Sampling::default();
    assert_answered(&run, "sampling", None, None);

    let halves = run.identification.half_cycles.clone();
    let n_small = halves.iter().filter(|half| half.amplitude_rad < 5_f64.to_radians()).count();
    assert!(n_small >= 16, "the decay is long enough for this story");
    assert_answered(&run, "small-cycles", Some(true), Some(n_small as f64 / 2.0));
    assert_answered(&run, "peaks", Some(true), Some(halves.len() as f64 + 1.0));
    for last_deg in [0.4, 0.6] {
        let last = run.identification.half_cycles.last_mut().unwrap();
        last.amplitude_rad = f64::to_radians(last_deg);
        let met = Some(last_deg < 0.5);
        assert_answered(&run, "down-to-half-a-degree", met, Some(last_deg));
    }
    run.identification.half_cycles.truncate(4);
    assert_answered(&run, "peaks", Some(false), Some(5.0));
}

#[test]
fn the_roll_left_by_the_run_before_is_told_apart_from_the_noise() {
    let mut run = first(RunKind::Decay);
    let noise_rad = run.identification.roll_noise_rad.mean;
    let roll_deg = 0.3_f64;
    run.run.still = Some(still(8.0, noise_rad));
    assert_answered(&run, "settled", Some(true), Some(0.0));
    let of_a_sine_rad = roll_deg.to_radians() / 2.0_f64.sqrt();
    run.run.still = Some(still(8.0, noise_rad.hypot(of_a_sine_rad)));
    assert_answered(&run, "settled", Some(false), Some(roll_deg));
}

#[test]
fn a_forced_run_is_asked_for_calm_for_periods_for_dense_sampling() {
    let mut run = first(RunKind::Forced);
    run.run.still = Some(still(20.0, 0.0));
    assert_answered(&run, "calm-before-forced", Some(true), Some(20.0));
    run.run.still = Some(still(12.0, 0.0));
    assert_answered(&run, "calm-before-forced", Some(false), Some(12.0));
    let frequency_rad_s = run.run.excitation_rad_s.expect("it repeats");
    run.run.end_s = run.run.start_s + 31.0 * std::f64::consts::TAU / frequency_rad_s;
    assert_answered(&run, "steady-periods", Some(true), Some(31.0));
    run.run.end_s = run.run.start_s + 9.0 * std::f64::consts::TAU / frequency_rad_s;
    assert_answered(&run, "steady-periods", Some(false), Some(9.0));
    run.run.excitation_rad_s = None;
    assert_answered(&run, "steady-periods", None, None);
    run.sampling = Sampling { roll_hz: Some(250.0), drive_hz: Some(100.0) };
    assert_answered(&run, "sampling", Some(false), Some(100.0));
}

#[test]
fn a_run_is_to_end_before_its_waves_are_back_from_the_walls_unless_it_outruns_them() {
    let mut campaign = synthetic_results::campaign("OE basin");
    let answer = |campaign: &Campaign, run: &IdentifiedRun| {
        let answers = procedure::of_run(campaign, run);
        answers.into_iter().find(|answer| answer.gate.id == "before-waves-return").expect("asked")
    };
    let mut run = first(RunKind::Decay);
    run.identification.natural_frequency_rad_s.mean = 6.905;
    run.speed_m_s = 0.0;
    (run.run.start_s, run.run.end_s) = (30.0, 43.0);
    campaign.tank.width_m = None;
    assert_eq!(answer(&campaign, &run).met, None);
    // A tank 10 m wide, a model 0.387 m wide: 9.613 m at 9.80665/(2 x 6.905) m/s are 13.54 s.
    campaign.tank.width_m = Some(10.0);
    campaign.hull.beam_m = 0.387;
    campaign.water.gravity_m_s2 = 9.80665;
    let told = answer(&campaign, &run);
    assert_eq!((told.met, told.value), (Some(true), Some(13.0)));
    assert!((told.limit.unwrap() - 13.54).abs() < 0.005, "{told:?}");
    run.run.end_s = 44.0;
    assert_eq!(answer(&campaign, &run).met, Some(false));
    // The limit is at 0.305 g/w = 0.4332 m/s.
    run.speed_m_s = 0.43;
    assert_eq!(answer(&campaign, &run).met, Some(false));
    run.speed_m_s = -0.44;
    assert_eq!(answer(&campaign, &run).met, Some(true));

    let mut forced = first(RunKind::Forced);
    forced.speed_m_s = 0.0;
    forced.run.excitation_rad_s = Some(5.12);
    forced.run.still = Some(still(20.0, 0.0));
    (forced.run.start_s, forced.run.end_s) = (35.0, 39.5);
    let told = answer(&campaign, &forced);
    // The rod began with the end of the rest, 9.5 s before; waves of 5.12 rad/s take 10.04 s.
    assert_eq!((told.met, told.value), (Some(true), Some(9.5)));
    assert!((told.limit.unwrap() - 10.04).abs() < 0.005, "{told:?}");
}

fn forced_at(shares: &[f64], natural_rad_s: f64) -> Results {
    let decay = first(RunKind::Decay);
    let forced = first(RunKind::Forced);
    let mut results = Results::default();
    for share in shares {
        let mut run = IdentifiedRun { froude: decay.froude, ..forced.clone() };
        let response = run.identification.forced.as_mut().expect("a forced run");
        response.frequency_rad_s.mean = share * natural_rad_s;
        results.runs.push(run);
    }
    results.runs.push(decay);
    results
}

#[test]
fn the_ladder_of_frequencies_names_the_rungs_that_are_missing() {
    let natural_rad_s = first(RunKind::Decay).identification.natural_frequency_rad_s.mean;
    let whole = [0.8, 0.9, 0.95, 0.975, 1.0, 1.05, 1.2, 0.93, 1.02, 1.1];
    let of = |shares: &[f64]| {
        let answers = procedure::of_campaign(&forced_at(shares, natural_rad_s));
        let ladder = answers.into_iter().find(|at| at.answer.gate.id == "frequency-ladder");
        ladder.expect("there are forced runs").answer
    };
    assert_eq!((of(&whole).met, of(&whole).value), (Some(true), Some(9.0)));
    let torn = of(&[0.805, 0.9, 0.95, 1.0, 1.05, 1.6]);
    assert_eq!((torn.met, torn.value), (Some(false), Some(5.0)), "{torn:?}");
    assert!(torn.words.starts_with("missing 0.975, 1.2 of"), "{}", torn.words);
}

#[test]
fn repeats_are_counted_at_each_condition_and_speed() {
    let mut results = synthetic_results::results();
    let extra = first(RunKind::Decay);
    results.runs.extend([extra.clone(), extra.clone(), extra]);
    let answers = procedure::of_campaign(&results);
    let repeats: Vec<_> = answers.iter().filter(|at| at.answer.gate.id == "repeats").collect();
    assert_eq!(repeats.len(), 10, "two conditions at five speeds");
    for at in repeats {
        let here = at.condition == "bare hull" && at.froude < 0.01;
        assert_eq!(at.answer.met, Some(here), "{at:?}");
        assert_eq!(at.answer.value, Some(if here { 4.0 } else { 1.0 }));
    }
}

#[test]
fn a_replayed_decay_says_the_same_on_its_page_and_in_the_contract() {
    let folder = CampaignFolder::new();
    assert_eq!(rolltank(folder.path(), &["replay", "."]).exit, 0);
    let results = folder.path().join("results");
    let document = std::fs::read_to_string(results.join("identification.json")).unwrap();
    let document: Value = serde_json::from_str(&document).unwrap();
    let run = &document["runs"][0];
    let page = format!("run-{}.html", run["id"].as_str().unwrap());
    let page = std::fs::read_to_string(results.join(page)).unwrap();
    let gates = run["gates"].as_array().unwrap();
    assert_eq!(gates.len(), 7);
    for gate in gates {
        assert!(page.contains(gate["words"].as_str().unwrap()), "{gate}");
    }
    // Three seconds at rest, then the hand heels the model; a hundred samples a second.
    assert_eq!(gates[0]["met"], true);
    let (rest_s, rate_hz) = (gates[0]["value"].as_f64().unwrap(), gates[2]["value"].as_f64());
    assert!((2.5..3.3).contains(&rest_s), "{rest_s} s");
    assert!((rate_hz.unwrap() - 100.0).abs() < 0.01);
}
