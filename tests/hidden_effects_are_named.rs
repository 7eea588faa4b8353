//! What hides in a simulated tank is named, or its class; what does not hide is not.
//!
//! A handful of drawn cases; the whole matrix is `cargo test --test hidden_matrix -- --all`.

use std::path::Path;

use serde_json::Value;

use super::campaign_folder::rolltank;
use super::hidden_tank::campaign::{Asked, Campaign, SCATTER};
use super::hidden_tank::draw::Draw;
use super::hidden_tank::effects::INVENTED;
use super::hidden_tank::fit::{INDISTINGUISHABLE, left_by, misfit};
use super::hidden_tank::folder::play;
use super::hidden_tank::next_run::decides;
use super::hidden_tank::plan::{Action, RunSet};
use super::hidden_tank::score::{Outcome, score};
use super::hidden_tank::verdict::{Verdict, diagnose};

/// Misfit of the base from which an effect must be found.
const DETECTABLE: f64 = 50.0;

/// Draws a campaign by name, shows which, and asks the program about it.
pub(crate) fn diagnosed(set: RunSet, hidden: &[&str], size: f64, seed: u64) -> (Campaign, Verdict) {
    let hidden: Vec<String> = hidden.iter().map(|id| (*id).to_owned()).collect();
    let asked = Asked { set, hidden, size, seed, scatter: SCATTER };
    let campaign = Campaign::draw(&asked);
    let place = tempfile::tempdir().expect("a place for a campaign");
    let played = play(&campaign, place.path());
    let program = Path::new(env!("CARGO_BIN_EXE_rolltank"));
    let verdict = diagnose(program, &played.folder)
        .unwrap_or_else(|complaint| panic!("{}: {complaint}", asked.name()));
    println!("{}: {} {:?}", asked.name(), verdict.word, verdict.causes);
    (campaign, verdict)
}

/// The outcome of a hidden effect that its own tank finds detectable.
fn outcome(set: RunSet, id: &str, size: f64, seed: u64) -> Outcome {
    let (campaign, verdict) = diagnosed(set, &[id], size, seed);
    let lambda = misfit(&campaign, &campaign.effects, None);
    assert!(lambda > DETECTABLE, "{id} leaves {lambda:.1}: no program could find it");
    // No help for an answer that only happens to fit: class or name.
    score(&verdict, &campaign.asked.hidden, set, |_, _| false)
}

/// The effects that a verdict names, in its order.
fn named(verdict: &Verdict) -> Vec<&str> {
    verdict.causes.iter().map(|cause| cause.effect.as_str()).collect()
}

/// A seed that nobody chose: the day's number of the story.
pub(crate) fn drawn_seed(story: &str) -> u64 {
    Draw::named(story).index(1000) as u64
}

#[test]
fn bearing_friction_is_named_from_decays_alone() {
    let seed = drawn_seed("friction");
    // The waves of an earlier run also fill a tail, and only a still record parts them for good.
    let told = outcome(RunSet::Rest, "damping.coulomb", 2.0, seed);
    assert!(matches!(told, Outcome::Named | Outcome::InClass), "{told:?}");
    let (_, verdict) = diagnosed(RunSet::Rest, &["damping.coulomb"], 2.0, seed);
    let cause = &verdict.json["causes"][0];
    assert_eq!(cause["effect"], "damping.coulomb");
    let rivals = cause["equivalent_to"].as_array().expect("a list");
    assert!(rivals.iter().all(|rival| rival == "tank.residual_wave"), "{rivals:?}");
    let [before, after] = ["before", "after"]
        .map(|when| verdict.json["gain"]["held_out_rmse_deg"][when].as_f64().expect("a number"));
    assert!(after < before, "held-out runs are foretold no better: {before} to {after} deg");
}

#[test]
fn a_cubic_restoring_is_named_with_its_class_and_the_run_that_parts_it() {
    let seed = drawn_seed("cubic restoring");
    let (campaign, verdict) = diagnosed(RunSet::Rest, &["restoring.cubic"], 1.0, seed);
    let class = ["restoring.cubic", "inertia.amplitude"];
    assert_eq!(verdict.word, "ambiguous");
    let [cause] = verdict.causes.as_slice() else { panic!("{:?}", verdict.causes) };
    let mut told = vec![cause.effect.as_str()];
    told.extend(cause.equivalent_to.iter().map(String::as_str));
    assert!(class.iter().all(|id| told.contains(id)), "{told:?}");
    // The run that it asks for parts the two.
    let program = Path::new(env!("CARGO_BIN_EXE_rolltank"));
    assert_eq!(decides(&campaign, &verdict, program), Some(true), "{}", verdict.json);
}

#[test]
fn once_the_model_knows_the_friction_the_identification_is_free_of_it() {
    let hidden = vec!["damping.coulomb".to_owned()];
    let seed = drawn_seed("friction taken off");
    let asked = Asked { set: RunSet::Rest, hidden, size: 2.0, seed, scatter: 0.0 };
    let campaign = Campaign::draw(&asked);
    let place = tempfile::tempdir().expect("a place for a campaign");
    let played = play(&campaign, place.path());
    let asks = |arguments: &[&str]| {
        let told = rolltank(&played.folder, arguments);
        assert!(told.exit == 0 || told.exit == 3, "{}", told.err);
        serde_json::from_str::<Value>(&told.out).expect("JSON")
    };
    // How far the linear damping of the large decays is from that of the hidden tank.
    let error = || -> f64 {
        let told = asks(&["identify", ".", "--json"]);
        let runs = told["runs"].as_array().expect("runs").iter().zip(&campaign.passes);
        let large = runs.filter(
            |(_, pass)| matches!(pass.action, Action::Decay { heel_rad } if heel_rad.abs() > 0.2),
        );
        let off = large.map(|(run, pass)| {
            let base = campaign.base_of(pass);
            let truth = base.b0 / base.inertia * pass.scatter[0];
            run["b1_per_s"]["mean"].as_f64().expect("a number") / truth - 1.0
        });
        off.map(f64::abs).fold(0.0, f64::max)
    };
    let before = error();
    asks(&["diagnose", ".", "--json", "--write-model"]);
    let after = error();
    println!("largest error of b1: {:.1} % before, {:.1} % after", 100.0 * before, 100.0 * after);
    assert!(after < 0.4 * before, "{before} {after}");
}

#[test]
fn forced_runs_part_what_decays_could_not() {
    let seed = drawn_seed("amplitude inertia");
    assert_eq!(outcome(RunSet::Forced, "inertia.amplitude", 1.0, seed), Outcome::Named);
}

#[test]
fn a_loose_pin_height_is_named_from_forced_runs() {
    let seed = drawn_seed("pin height");
    assert_eq!(outcome(RunSet::Forced, "exciter.pin_height", 1.0, seed), Outcome::Named);
}

#[test]
fn a_clean_campaign_is_adequate() {
    for set in [RunSet::Rest, RunSet::Forced] {
        let (_, verdict) = diagnosed(set, &[], 1.0, drawn_seed("clean"));
        assert_eq!((verdict.word.as_str(), verdict.causes.len()), ("adequate", 0));
    }
}

#[test]
fn a_wrong_gain_is_no_finding_because_no_run_of_the_campaign_can_show_it() {
    let (_, verdict) = diagnosed(RunSet::Rest, &["instrument.roll_gain"], 2.0, drawn_seed("gain"));
    assert_eq!((verdict.word.as_str(), verdict.causes.len()), ("adequate", 0));
}

#[test]
fn what_is_in_no_catalogue_is_given_no_name() {
    let invented = INVENTED[Draw::named("invented").index(INVENTED.len())].id;
    let (campaign, verdict) = diagnosed(RunSet::Rest, &[invented], 2.0, drawn_seed(invented));
    // Unless a catalogued effect does the very same to these runs, which nobody could tell.
    let worth = score(&verdict, &campaign.asked.hidden, RunSet::Rest, |cause, hidden| {
        left_by(&campaign, cause, hidden) < INDISTINGUISHABLE
    });
    assert!([Outcome::Unexplained, Outcome::InClass].contains(&worth), "{worth:?}");
}

#[test]
fn a_keel_that_is_lost_is_no_wave_because_the_tank_has_none_of_that_frequency() {
    // A wave near the roll's own frequency takes up most of what such a keel leaves.
    let (_, verdict) = diagnosed(RunSet::Rest, &["invented.lost_keel"], 1.0, 651);
    assert_eq!((verdict.word.as_str(), verdict.causes.len()), ("unexplained", 0));
}

#[test]
fn water_in_the_hull_is_named_where_a_fit_under_white_noise_strays_from_its_numbers() {
    for (set, size, seed) in [(RunSet::Speeds, 2.0, 884), (RunSet::Rest, 1.0, 887)] {
        let (_, verdict) = diagnosed(set, &["restoring.free_surface"], size, seed);
        assert_eq!(named(&verdict), ["restoring.free_surface"]);
    }
}

#[test]
fn water_in_the_hull_is_named_by_what_the_model_does_after_its_decays() {
    // Its beat cuts these decays short, and they alone stay unexplained.
    let (campaign, verdict) = diagnosed(RunSet::Rest, &["restoring.free_surface"], 1.0, 710);
    assert_eq!(verdict.word, "named", "{:?}", verdict.causes);
    assert_eq!(verdict.causes[0].effect, "restoring.free_surface");
    let numbers = verdict.json["causes"][0]["parameters"].as_array().expect("a list");
    let of = |symbol: &str, what: &str| -> f64 {
        let number = numbers.iter().find(|number| number["symbol"] == symbol).expect("it is told");
        number[what].as_f64().expect("a number")
    };
    // Heeling the model stirred the water, which then is no more at rest than a release is.
    let (base, values) = (&campaign.base, &campaign.effects[0].values);
    let truths = [
        ("kt", values[0] / base.restoring),
        ("wt/w", values[1] / base.natural_rad_s()),
        ("z", values[2]),
    ];
    for (symbol, truth) in truths {
        let off = (of(symbol, "mean") - truth) / of(symbol, "sd");
        assert!(off.abs() < 4.0, "{symbol} is {off:.1} sd off {truth}");
        // Without the roll before the release its state is a guess, and so is a tenth of these.
        let share = of(symbol, "sd") / truth;
        assert!(share < 0.03, "{symbol} is known to {:.0} % only", 100.0 * share);
    }
}

#[test]
fn a_second_cause_is_found_beside_one_that_fills_the_record() {
    let cases = [
        (RunSet::Forced, ["tank.wall_reflection", "damping.displacement_weighted"], 3716),
        (RunSet::Speeds, ["instrument.roll_offset", "run.mislabelled"], 3751),
        (RunSet::Speeds, ["instrument.roll_backlash", "damping.quadratic"], 3739),
        (RunSet::Speeds, ["instrument.roll_backlash", "restoring.free_surface"], 3818),
        (RunSet::Speeds, ["run.mislabelled", "tank.wall_reflection"], 4109),
    ];
    let missed = cases.into_iter().filter_map(|(set, hidden, seed)| {
        let (campaign, verdict) = diagnosed(set, &hidden, 2.0, seed);
        let told = score(&verdict, &campaign.asked.hidden, set, |_, _| false);
        let is_both = matches!(told, Outcome::Named | Outcome::InClass);
        (!is_both).then(|| format!("{hidden:?}: {told:?}"))
    });
    assert_eq!(missed.collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn waves_from_the_walls_leave_no_other_name_beside_them() {
    // Their form leaves some thousandths of the motion, which other effects took up before it came;
    // what the first periods say of them is too little to tell a crumb of it in all that follows.
    let cases = [(RunSet::Rest, 1.0, 851), (RunSet::Speeds, 2.0, 851), (RunSet::Forced, 0.5, 880)];
    for (set, size, seed) in cases {
        let (_, verdict) = diagnosed(set, &["tank.wall_reflection"], size, seed);
        assert_eq!(named(&verdict), ["tank.wall_reflection"]);
    }
}

#[test]
fn a_run_that_may_not_decide_is_told_as_such_and_none_is_asked_for_in_vain() {
    let asked = |set, id, size, seed| {
        let (_, verdict) = diagnosed(set, &[id], size, seed);
        let next = verdict.json["next_run"].clone();
        let parts = next["parts"].as_array().expect("it is told").len();
        (next["decides"].as_bool().expect("it is told"), parts, next["why"].to_string())
    };
    // A short skew differs from a lag as short at no frequency that the rod reaches.
    let (decides, parts, why) = asked(RunSet::Forced, "instrument.channel_skew", 2.0, 871);
    assert!(!decides && parts == 0 && why.contains("no run that this tank allows"), "{why}");
    assert!(why.contains("a tap on the model"), "{why}");
    // What parts a drift of the clock from either of these does not part them.
    let (decides, parts, why) = asked(RunSet::Forced, "instrument.channel_skew", 1.0, 851);
    assert!(!decides && parts > 2 && why.contains("which may not decide"), "{why}");
    let seed = drawn_seed("cubic restoring");
    let (decides, parts, why) = asked(RunSet::Rest, "restoring.cubic", 1.0, seed);
    assert!(decides && parts > 1 && !why.contains("may not"), "{why}");
}

#[test]
fn the_runs_asked_for_part_what_a_rival_could_take_for_scatter() {
    // Off resonance at one frequency, what either leaves could be a run that lies off its law.
    let (campaign, verdict) = diagnosed(RunSet::Rest, &["inertia.amplitude"], 0.5, 871);
    assert!(verdict.json["next_run"]["decides"] == true, "{}", verdict.json["next_run"]);
    let program = Path::new(env!("CARGO_BIN_EXE_rolltank"));
    assert_eq!(decides(&campaign, &verdict, program), Some(true));
}

#[test]
fn a_carriage_that_shakes_the_model_is_named_and_hides_no_other_cause() {
    // Bilge keels leave little of a roll but the shaking, which lies among its harmonics.
    let told = outcome(RunSet::Speeds, "tank.carriage_vibration", 2.0, 763);
    assert_eq!(told, Outcome::Named);
    let hidden = ["damping.quadratic", "tank.carriage_vibration"];
    let (_, verdict) = diagnosed(RunSet::Speeds, &hidden, 2.0, 3949);
    assert_eq!(named(&verdict), hidden);
}

#[test]
fn a_load_cell_that_creeps_since_the_model_was_at_rest_brings_no_wrong_zero() {
    let seed = drawn_seed("creeping load cell");
    let told = outcome(RunSet::Forced, "instrument.force_drift", 2.0, seed);
    assert_eq!(told, Outcome::Named);
}

#[test]
fn the_end_of_a_range_is_seen_where_the_model_was_held_beyond_it() {
    // No crest after the release reaches as far.
    let told = outcome(RunSet::Rest, "instrument.clipping", 0.5, 760);
    assert_eq!(told, Outcome::Named);
}

#[test]
fn no_run_is_asked_for_that_the_roll_channel_cannot_read() {
    let hidden = ["restoring.speed", "instrument.clipping"];
    let (_, verdict) = diagnosed(RunSet::Speeds, &hidden, 2.0, 4165);
    let next = &verdict.json["next_run"];
    let asked_deg = next["amplitude_deg"].as_f64().expect("a run is asked for");
    // Of the 12 degrees that the model is heeled to, the channel reads three fifths.
    assert!(asked_deg.abs() < 0.6 * 12.0, "{next}");
}

#[test]
fn samples_lost_at_any_instant_hide_no_other_cause() {
    let hidden = ["instrument.dropped_samples", "damping.start_up"];
    let asked = ["damping.start_up", "instrument.dropped_samples"];
    let (_, verdict) = diagnosed(RunSet::Speeds, &asked, 2.0, 4100);
    assert_eq!(named(&verdict), hidden);
}

#[test]
fn a_class_is_parted_once_another_cause_is_known_that_hid_the_difference() {
    let hidden = ["inertia.amplitude", "damping.displacement_weighted"];
    let (_, verdict) = diagnosed(RunSet::Forced, &hidden, 2.0, 3830);
    assert_eq!((verdict.word.as_str(), named(&verdict)), ("named", hidden.to_vec()));
}

#[test]
fn a_heel_is_told_from_a_wrong_zero_by_a_damping_that_knows_the_angle() {
    let hidden = ["restoring.heel", "damping.displacement_weighted"];
    let (_, verdict) = diagnosed(RunSet::Rest, &hidden, 2.0, drawn_seed("heel and damping"));
    assert_eq!(named(&verdict), hidden);
}

#[test]
fn a_slow_filter_is_no_skew_between_channels() {
    let seed = drawn_seed("roll lag");
    assert_eq!(outcome(RunSet::Forced, "instrument.roll_lag", 2.0, seed), Outcome::Named);
}

#[test]
fn a_run_refused_for_the_sign_of_its_force_is_told_among_the_causes() {
    let hidden = ["instrument.channel_skew", "run.mislabelled"];
    let (_, verdict) = diagnosed(RunSet::Forced, &hidden, 2.0, 3637);
    assert_eq!(named(&verdict), hidden);
}

#[test]
fn two_causes_are_not_taken_for_one_that_looks_like_both() {
    // Vortices look like both, and the law of no cause does better than either alone.
    let pairs = [
        (["restoring.cubic", "damping.quadratic"], 3594),
        (["instrument.roll_nonlinearity", "restoring.asymmetric"], 3567),
    ];
    for (hidden, seed) in pairs {
        let (campaign, verdict) = diagnosed(RunSet::Speeds, &hidden, 2.0, seed);
        let told = score(&verdict, &campaign.asked.hidden, RunSet::Speeds, |_, _| false);
        assert!(matches!(told, Outcome::Named | Outcome::InClass), "{hidden:?}: {told:?}");
    }
}

#[test]
fn a_loose_pin_is_named_by_its_ringing_and_by_what_the_roll_lags() {
    let told = outcome(RunSet::Forced, "exciter.pin_play", 1.0, 710);
    assert_eq!(told, Outcome::Named);
    // Loud ringing leaves no other name beside it: it begins where the force changes sign.
    let seed = drawn_seed("loud pin");
    let (_, verdict) = diagnosed(RunSet::Forced, &["exciter.pin_play"], 2.0, seed);
    assert_eq!(named(&verdict), ["exciter.pin_play"]);
}

#[test]
fn a_carriage_that_wobbles_is_named_from_its_own_record_where_the_roll_hardly_shows_it() {
    let first = drawn_seed("a wobbling carriage");
    let wobble = |seed: u64| {
        let hidden = vec!["tank.unsteady_speed".to_owned()];
        let asked = Asked { set: RunSet::Speeds, hidden, size: 0.5, seed, scatter: SCATTER };
        let [share, hz] = Campaign::draw(&asked).effects[0].values[..] else { panic!("values") };
        (hz > 0.0).then_some((seed, share, hz))
    };
    // Half of the unsteady carriages settle late instead.
    let (seed, share, hz) = (first..).find_map(wobble).expect("a wobble");
    let (_, verdict) = diagnosed(RunSet::Speeds, &["tank.unsteady_speed"], 0.5, seed);
    assert_eq!(named(&verdict), ["tank.unsteady_speed"]);
    let parameters = verdict.json["causes"][0]["parameters"].as_array().expect("a list");
    let of = |symbol: &str| -> Vec<f64> {
        let told = parameters.iter().filter(|parameter| parameter["symbol"] == symbol);
        told.map(|parameter| parameter["mean"].as_f64().expect("a number")).collect()
    };
    let (shares, frequencies) = (of("dv"), of("f"));
    assert!(frequencies.len() > 5, "{parameters:?}");
    assert!(frequencies.iter().all(|told| (told - hz).abs() < 0.03), "{hz} Hz: {frequencies:?}");
    assert!(shares.iter().all(|told| (told / share - 1.0).abs() < 0.1), "{share}: {shares:?}");
}

#[test]
fn at_resonance_a_loose_pin_rings_louder_than_the_rod_pushes_and_is_named() {
    let (_, verdict) = diagnosed(RunSet::Forced, &["exciter.pin_play"], 2.0, 872);
    assert_eq!(named(&verdict), ["exciter.pin_play"]);
}

#[test]
fn samples_that_all_channels_lost_leave_no_trace_in_the_moment() {
    let (_, verdict) = diagnosed(RunSet::Forced, &["instrument.dropped_samples"], 2.0, 853);
    assert_eq!(named(&verdict), ["instrument.dropped_samples"]);
}

#[test]
fn beside_water_in_the_hull_a_trifle_gets_no_name() {
    let (_, verdict) = diagnosed(RunSet::Forced, &["restoring.free_surface"], 2.0, 874);
    assert_eq!(named(&verdict), ["restoring.free_surface"]);
}

#[test]
fn waves_are_sought_at_other_modes_once_the_damping_beside_them_is_known() {
    let hidden = ["tank.residual_wave", "damping.vortex_history"];
    let (_, verdict) = diagnosed(RunSet::Speeds, &hidden, 2.0, 4392);
    assert_eq!(named(&verdict), hidden);
}
