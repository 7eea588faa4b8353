//! `rolltank diagnose`: nothing is found where nothing is wrong, and a cause where there is one.

use std::fs;
use std::path::PathBuf;

use rolltank::campaign;
use rolltank::diagnosis::{Diagnosis, Verdict};
use rolltank::model::effects;
use rolltank::model::model_file::ModelFile;
use rolltank::pipeline::{self, Learnt, Observed, Options};
use rolltank::report::{DIAGNOSIS_SCHEMA, diagnosis_json, diagnosis_text};
use serde_json::Value;

use super::campaign_folder::rolltank;
use super::hidden_tank::campaign::{Asked, Campaign, SCATTER};
use super::hidden_tank::folder::play;
use super::hidden_tank::plan::RunSet;
use super::json_schema;

/// Two decays at rest, with whatever is wrong with their channel.
fn scenario(wrong: &str) -> String {
    let pass = |heel: &str| {
        format!(
            "[[pass]]\ncondition = \"bare hull\"\nfroude = 0.0\n{wrong}\naction = [\n\
             {{ rest = {{ duration_s = 4.0 }} }},\n\
             {{ hold = {{ heel_deg = {heel}, duration_s = 8.0, ramp_s = 1.5 }} }},\n\
             {{ release = {{ duration_s = 16.0 }} }},\n]\n"
        )
    };
    format!(
        "name = \"two decays\"\n[hull]\nlength_pp_m = 2.5\nbeam_m = 0.387\ndraft_m = 0.132\n\
         displacement_m3 = 0.110\ngm_m = 0.074\n[tank]\nlength_m = 50.0\nwidth_m = 10.0\n\
         depth_m = 5.0\ncarriage_max_speed_m_s = 2.0\n[instruments.roll]\n\
         sample_rate_hz = 50.0\nnoise_deg = 0.05\n[[condition]]\nname = \"bare hull\"\n\
         natural_frequency_rad_s = 6.905\n\
         damping.law = {{ b0_per_s = 0.38, kappa = 11.9, b3_s = 0.144, scatter_per_s = 0.0 }}\n\
         {}{}",
        pass("12.0"),
        pass("-6.0")
    )
}

/// The document of a simulated campaign, and the folder that holds it.
fn diagnosed(wrong: &str, more: &[&str]) -> (Value, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fs::write(folder.path().join("scenario.toml"), scenario(wrong)).expect("the disk has room");
    let made = rolltank(folder.path(), &["simulate", "scenario.toml", "-o", "day"]);
    assert_eq!(made.exit, 0, "{}", made.err);
    let mut arguments = vec!["diagnose", "day", "--json"];
    arguments.extend(more);
    let told = rolltank(folder.path(), &arguments);
    assert_eq!(told.exit, 0, "{}", told.err);
    (serde_json::from_str(&told.out).expect("JSON"), folder)
}

fn schema() -> Value {
    serde_json::from_str(DIAGNOSIS_SCHEMA).expect("the schema is JSON")
}

#[test]
fn a_simulation_that_lacks_nothing_is_adequate_and_no_file_is_written() {
    let (document, folder) = diagnosed("", &[]);
    assert_eq!(json_schema::violations(&schema(), &document), Vec::<String>::new());
    assert_eq!(document["verdict"], "adequate", "{document:#}");
    assert_eq!(document["causes"], Value::Array(Vec::new()));
    for left in document["residual"]["moment_after"].as_array().expect("a list") {
        let outside = left["share_of_instants_outside"].as_f64().expect("a number");
        assert!(outside < 0.15, "the band of the unexplained moment excludes nil: {left:#}");
    }
    assert!(!folder.path().join("day/results").exists());
}

#[test]
fn a_zero_that_was_never_taken_is_named_with_the_heel_that_no_roll_test_parts_from_it() {
    let (document, folder) = diagnosed("zero = { roll_deg = 0.2 }", &["--write-model"]);
    assert_eq!(json_schema::violations(&schema(), &document), Vec::<String>::new());
    assert_eq!(document["verdict"], "ambiguous", "{document:#}");
    let cause = &document["causes"][0];
    assert_eq!(cause["effect"], "instrument.roll_offset");
    assert_eq!(cause["equivalent_to"][0], "restoring.heel");
    let zero = &cause["parameters"][0];
    let (low, high) = (zero["lo95"].as_f64().unwrap(), zero["hi95"].as_f64().unwrap());
    assert!((low..high).contains(&0.2_f64.to_radians()), "{low} to {high}");
    assert_eq!(document["next_run"]["kind"], "rest_reading");
    let gain = &document["gain"]["held_out_rmse_deg"];
    assert!(gain["after"].as_f64() < gain["before"].as_f64(), "{gain}");
    let model = fs::read_to_string(folder.path().join("day/results/model.toml")).unwrap();
    let model = ModelFile::from_toml(&model).expect("what was written can be read");
    assert_eq!(model.effects[0].id, "instrument.roll_offset");
}

#[test]
fn the_moment_that_the_simulation_lacks_is_shown_before_and_after_it_is_named() {
    let wrong = "waves = { moment_n_m = 0.03, frequency_rad_s = 6.3, decay_s = 1e6 }";
    let (document, folder) = diagnosed(wrong, &[]);
    assert_eq!(json_schema::violations(&schema(), &document), Vec::<String>::new());
    let share = |when: &str| -> f64 {
        let runs = document["residual"][when].as_array().expect("a list");
        let shares = runs.iter().map(|left| left["share_of_instants_outside"].as_f64());
        shares.map(|share| share.expect("a number")).fold(0.0, f64::max)
    };
    let (before, after) = (share("moment_before"), share("moment_after"));
    assert!(before > 0.07 && after < 0.03, "{before} before, {after} after");
    // What is shown before has the size of the wave that was hidden [N m].
    let left = &document["residual"]["moment_before"][0]["mean_n_m"];
    let left: Vec<f64> = left.as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    let rms = (left.iter().map(|m| m * m).sum::<f64>() / left.len() as f64).sqrt();
    assert!((0.3 * 0.03..1.5 * 0.03).contains(&rms), "{rms} N m");
    let report = rolltank(folder.path(), &["report", "day", "-o", "told"]);
    assert_eq!(report.exit, 0, "{}", report.err);
    let page = fs::read_to_string(folder.path().join("told/diagnosis.html")).unwrap();
    for section in ["causes", "gain", "bias", "unexplained-moment", "against-motion", "left"] {
        assert!(page.contains(&format!("id=\"{section}\"")), "{section}");
    }
    let index = fs::read_to_string(folder.path().join("told/index.html")).unwrap();
    assert!(index.contains("href=\"diagnosis.html\""));
}

#[test]
fn where_no_release_makes_a_run_the_reasons_are_told_with_what_beats_like_that() {
    let asked = Asked {
        set: RunSet::Rest,
        hidden: vec!["restoring.free_surface".to_owned()],
        size: 2.0,
        seed: 883,
        scatter: SCATTER,
    };
    let place = tempfile::tempdir().expect("a folder can be made");
    let played = play(&Campaign::draw(&asked), place.path());
    let told = rolltank(&played.folder, &["diagnose", "."]);
    assert_eq!(told.exit, 3, "{}", told.out);
    assert!(told.out.starts_with("no run could be diagnosed\n\nnot used:\n"), "{}", told.out);
    for said in ["pass_01", "pass_04", "the roll left its course", "hint: in 4 recordings"] {
        assert!(told.out.contains(said), "{said}: {}", told.out);
    }
    let json = rolltank(&played.folder, &["diagnose", ".", "--json"]);
    assert_eq!(json.exit, 3, "{}", json.out);
    let document: Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(document["verdict"], Value::Null, "{document:#}");
}

#[test]
fn the_same_recordings_give_the_same_bytes() {
    let wrong = "waves = { moment_n_m = 0.02, frequency_rad_s = 6.3, decay_s = 1e6 }";
    let ((first, _), (second, _)) = (diagnosed(wrong, &[]), diagnosed(wrong, &[]));
    assert_eq!(first.to_string(), second.to_string());
    assert_ne!(first["verdict"], "adequate", "{first:#}");
}

#[test]
fn every_effect_has_a_name_of_its_own_and_says_what_it_is() {
    let mut ids: Vec<&str> = effects::all().iter().map(|effect| effect.id).collect();
    for effect in effects::all() {
        assert!(!effect.equation.is_empty() && !effect.reference.is_empty(), "{}", effect.id);
        for k in 0..effect.n_parameters() {
            let [low, high] = effect.parameter(k).range;
            assert!(low < high, "{}", effect.id);
        }
    }
    ids.extend(effects::UNTESTABLE.iter().map(|(id, _)| *id));
    let n = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), n);
}

/// The runs of the measured campaign up to a Froude number; none where the data are not at hand.
fn kvlcc2(to_froude: f64) -> Option<Diagnosis> {
    let root = std::env::var_os("ROLLTANK_MEASURED").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/measured"),
        PathBuf::from,
    );
    let folder = root.join("kvlcc2");
    if !folder.is_dir() {
        println!("no measured data at {}: story not told", folder.display());
        return None;
    }
    let campaign = campaign::read(&folder).expect("the campaign file is right");
    let mut observed = Observed::default();
    pipeline::replay(&campaign, &Options::default(), &mut |_| {}, &mut |learnt| {
        let is_asked_about = match learnt {
            Learnt::Run(run, _) => run.froude <= to_froude,
            _ => true,
        };
        if is_asked_about {
            observed.hear(learnt, &campaign);
        }
        Ok(())
    })
    .expect("the recordings can be read");
    Some(observed.diagnosed(&campaign).expect("there is a run"))
}

#[test]
fn the_measured_tanker_lacks_cubic_restoring_or_an_inertia_that_changes_with_the_roll() {
    let Some(diagnosis) = kvlcc2(0.0) else { return };
    let document: Value = serde_json::from_str(&diagnosis_json(Some(&diagnosis))).expect("JSON");
    assert_eq!(json_schema::violations(&schema(), &document), Vec::<String>::new());
    assert_names_the_class_first(&diagnosis);
    let energy = |left: &[rolltank::diagnosis::Leftover]| left[0].rms.powi(2);
    let gain = energy(&diagnosis.left_before) / energy(&diagnosis.left_after);
    assert!(gain > 50.0, "residual energy falls by {gain:.0} times");
    // The bumps 20 to 25 s after the release, locked to time, stay unexplained where they are.
    let moment = &document["residual"]["moment_after"][0];
    let calm = share_outside(moment, 10.0..15.0);
    let bumps = share_outside(moment, 20.0..25.0);
    println!(
        "outside the band: {calm:.2} of 10 to 15 s after the release, {bumps:.2} of 20 to 25 s"
    );
    assert!(bumps > 0.3 && bumps > 3.0 * calm, "{bumps} and {calm}");
    let next = diagnosis.next_run.expect("a run that parts them");
    assert_eq!(next.run.kind, "forced", "{}", next.why);
}

/// Share of the instants of a stretch after the release [s] at which no moment at all is outside
/// the 95 % band of the unexplained one.
fn share_outside(moment: &Value, stretch_s: std::ops::Range<f64>) -> f64 {
    let of = |key: &str| -> Vec<f64> {
        let values = moment[key].as_array().expect("a list").iter();
        values.map(|value| value.as_f64().expect("a number")).collect()
    };
    let (time_s, mean, sd) = (of("time_s"), of("mean_n_m"), of("sd_n_m"));
    let inside: Vec<usize> =
        (0..time_s.len()).filter(|k| stretch_s.contains(&(time_s[*k] - time_s[0]))).collect();
    let n_outside = inside.iter().filter(|k| mean[**k].abs() > 1.96 * sd[**k]).count();
    n_outside as f64 / inside.len() as f64
}

#[test]
fn beside_its_class_the_measured_tanker_keeps_what_no_cause_explains() {
    let Some(diagnosis) = kvlcc2(1.0) else { return };
    assert_names_the_class_first(&diagnosis);
    assert_eq!(diagnosis.causes.len(), 1, "{:?}", diagnosis.causes);
    // Waves near the roll's own frequency take up a part, and leave most of it.
    assert!(!diagnosis.suspects.is_empty());
    for left in &diagnosis.left_after {
        assert!(left.is_sure(), "{left:?}");
        assert!(left.share < 1e-3, "{left:?}");
    }
    // What the model did after its decays was not searched to the end, though the runs were.
    assert!(diagnosis.cut_short);
    // The bumps of the run under way are told where they are: in the seconds after its release.
    let under_way = diagnosis.left_after.iter().find(|left| left.run.contains("21340"));
    let time_s = under_way.map_or(0.0, |left| left.time_s);
    assert!((23.0..27.0).contains(&time_s), "{time_s} s");
}

#[test]
fn a_search_that_ended_early_says_so() {
    let Some(mut diagnosis) = kvlcc2(0.0) else { return };
    let told = |diagnosis: &Diagnosis| -> (Value, String) {
        let document = serde_json::from_str(&diagnosis_json(Some(diagnosis))).expect("JSON");
        (document, diagnosis_text(Some(diagnosis)))
    };
    let (document, text) = told(&diagnosis);
    assert_eq!(document["cut_short"], false, "one decay is searched to the end");
    assert!(!text.contains("ended at what it may cost"), "{text}");
    diagnosis.cut_short = true;
    let (document, text) = told(&diagnosis);
    assert_eq!(json_schema::violations(&schema(), &document), Vec::<String>::new());
    assert_eq!(document["cut_short"], true);
    assert!(text.contains("ended at what it may cost"), "{text}");
}

/// Cubic restoring and the inertia that changes with the roll are one class in any decay.
fn assert_names_the_class_first(diagnosis: &Diagnosis) {
    assert_eq!(diagnosis.verdict, Verdict::Ambiguous, "{:?}", diagnosis.causes);
    let first = &diagnosis.causes[0];
    let mut class = vec![first.effect];
    class.extend(&first.equivalent_to);
    for one in ["restoring.cubic", "inertia.amplitude"] {
        assert!(class.contains(&one), "{class:?}");
    }
}
