//! The tank that hides effects is itself right: its integrator, its runs, its measure of an effect.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use serde_json::Value;

use super::campaign_folder::rolltank;
use super::hidden_tank::base::Base;
use super::hidden_tank::campaign::{Asked, Campaign, SCATTER};
use super::hidden_tank::effects::{CATALOGUED, INVENTED};
use super::hidden_tank::fit::{misfit, misfit_beside};
use super::hidden_tank::folder::{play, truth};
use super::hidden_tank::foretold::{self, Stretch};
use super::hidden_tank::instruments::ROLL_NOISE_RAD;
use super::hidden_tank::integrate::{State, step};
use super::hidden_tank::motion::simulate;
use super::hidden_tank::plan::{Pass, RunSet};
use super::hidden_tank::timeline::Timeline;

fn asked(set: RunSet, hidden: &[&str], size: f64, seed: u64) -> Asked {
    let hidden = hidden.iter().map(|id| (*id).to_owned()).collect();
    Asked { set, hidden, size, seed, scatter: SCATTER }
}

#[test]
fn the_integrator_is_of_order_four() {
    // phi'' = -w^2 phi from 1: the phase error of one step falls with the fifth power of the step.
    let error = |step_s: f64| {
        let n = (4.0 / step_s).round() as usize;
        let mut y = State::default();
        y[0] = 1.0;
        for k in 0..n {
            y = step(k as f64 * step_s, step_s, &y, 2, |_, y| {
                let mut rates = State::default();
                (rates[0], rates[1]) = (y[1], -49.0 * y[0]);
                rates
            });
        }
        (y[0] - (7.0_f64 * 4.0).cos()).abs()
    };
    let (coarse, fine) = (error(0.02), error(0.01));
    assert!((12.0..20.0).contains(&(coarse / fine)), "{coarse} to {fine}");
    assert!(fine < 1e-6, "{fine}");
}

#[test]
fn a_free_model_without_damping_rolls_for_ever_at_its_natural_frequency() {
    let mut base = Base::of_hull(false);
    (base.b0, base.b3) = (0.0, 0.0);
    let campaign = Campaign::draw(&asked(RunSet::Rest, &[], 1.0, 0));
    let motion = simulate(&campaign.passes[0], &base, &Vec::new(), 0.005, None);
    let release = motion.time_s.partition_point(|time_s| *time_s < 14.0 - 1e-9);
    let heel = motion.roll[release];
    assert!((heel - 15.0_f64.to_radians()).abs() < 1e-9);
    for (time_s, roll) in motion.time_s.iter().zip(&motion.roll).skip(release) {
        let exact = heel * (6.905 * (time_s - 14.0)).cos();
        assert!((roll - exact).abs() < 1e-5 * heel, "{time_s} s: {roll}, not {exact}");
    }
}

#[test]
fn the_rod_pays_what_the_damping_takes() {
    let campaign = Campaign::draw(&asked(RunSet::Forced, &[], 1.0, 0));
    let pass = &campaign.passes[4];
    let motion = simulate(pass, &campaign.base, &Vec::new(), 0.001, None);
    // Work of one period of 5 degrees at 5.12 rad/s, against pi w A^2 B_eq.
    let (w, amplitude) = (5.12, 5.0_f64.to_radians());
    let n = (TAU / w / 0.001).round() as usize;
    let work: f64 = (20_000..20_000 + n)
        .map(|i| motion.moment[i] * (motion.roll[i + 1] - motion.roll[i - 1]) / 2.0)
        .sum();
    let [linear, cubic] = pass.scatter;
    let b_eq =
        linear * campaign.base.b0 + 0.75 * (w * amplitude).powi(2) * cubic * campaign.base.b3;
    let expected = TAU / 2.0 * w * amplitude.powi(2) * b_eq;
    assert!((work / expected - 1.0).abs() < 0.01, "{work}, not {expected}");
}

#[test]
fn every_catalogued_effect_can_hide_and_does_something_where_it_can() {
    let ids: BTreeSet<&str> = CATALOGUED.iter().map(|row| row.id).collect();
    assert_eq!(ids.len(), CATALOGUED.len(), "a name is there twice");
    assert!(INVENTED.len() >= 5 && INVENTED.iter().all(|row| !ids.contains(row.id)));
    for row in CATALOGUED.iter().chain(&INVENTED) {
        let shows = |set: RunSet| {
            let campaign = Campaign::draw(&asked(set, &[row.id], 1.0, 0));
            assert_eq!(campaign.effects[0].values.len(), row.symbols.len(), "{}", row.id);
            campaign.passes.iter().any(|pass| {
                let with = campaign.rows(pass, false);
                let without = campaign.rows_with(&[], &pass.as_labelled(), false);
                let pairs = with.roll_deg.iter().zip(&without.roll_deg);
                let forces = with.force_n.iter().zip(&without.force_n);
                let speeds = with.speed_m_s.iter().zip(&without.speed_m_s);
                pairs.chain(forces).chain(speeds).any(|(a, b)| (a - b).abs() > 1e-3)
            })
        };
        assert!(shows(RunSet::Forced) || shows(RunSet::Speeds), "{} does nothing", row.id);
    }
}

#[test]
fn the_base_takes_up_itself_and_a_cable_but_no_friction() {
    let left = |id: &str| {
        let campaign = Campaign::draw(&asked(RunSet::Rest, &[id], 1.0, 0));
        misfit(&campaign, &campaign.effects, None)
    };
    let clean = Campaign::draw(&asked(RunSet::Rest, &[], 1.0, 0));
    assert!(misfit(&clean, &[], None) < 0.1);
    // A spring is a larger K, which the prior of 2 % lets the inertia hide.
    assert!(left("restoring.cable") < 1.0);
    assert!(left("damping.coulomb") > 1000.0);
}

#[test]
fn a_hull_off_its_frequency_leaves_nothing_to_find() {
    // The largest of the range, in long decays that it puts a cycle off.
    for seed in [880, 881] {
        let hidden = ["restoring.natural_frequency"];
        let campaign = Campaign::draw(&asked(RunSet::Rest, &hidden, 2.0, seed));
        let lambda = misfit(&campaign, &campaign.effects, None);
        assert!(lambda < 5.0, "{lambda} of seed {seed}");
    }
}

#[test]
fn cubic_restoring_and_amplitude_inertia_are_one_class_in_decays() {
    let hidden = Campaign::draw(&asked(RunSet::Rest, &["restoring.cubic"], 1.0, 0));
    let beside = Campaign::draw(&asked(RunSet::Rest, &["inertia.amplitude"], 1.0, 0));
    let alone = misfit(&hidden, &hidden.effects, None);
    let left = misfit(&hidden, &hidden.effects, Some(&beside.effects[0]));
    assert!(alone > 1000.0 && left < 12.0, "{left} of {alone} is left");
}

#[test]
fn what_one_hidden_effect_takes_up_is_not_left_of_the_other() {
    let hidden = ["restoring.cubic", "inertia.amplitude"];
    let both = Campaign::draw(&asked(RunSet::Rest, &hidden, 1.0, 0));
    let alone = misfit(&both, &both.effects[1..], None);
    let beside = misfit_beside(&both, &both.effects[0]);
    assert!(alone > 1000.0 && beside < 12.0, "{beside} of {alone} is left");
}

/// Error of the true model over the whole of every pass [deg].
fn planned_error_deg(campaign: &Campaign) -> f64 {
    let whole = |pass: &Pass| {
        let line = Timeline::of(pass);
        Stretch { pass: pass.index, from_s: line.start_s, to_s: line.end_s }
    };
    let runs: Vec<Stretch> = campaign.passes.iter().map(whole).collect();
    foretold::rmse_deg(campaign, &runs).expect("a campaign has runs")
}

#[test]
fn the_true_model_foretells_all_of_a_run_but_its_noise_and_what_the_day_drew_for_it() {
    let noise_deg = ROLL_NOISE_RAD.to_degrees();
    let error_deg = |id: &str, scatter: f64| {
        let asked = Asked { scatter, ..asked(RunSet::Speeds, &[id], 2.0, 1) };
        planned_error_deg(&Campaign::draw(&asked)) / noise_deg
    };
    for id in ["restoring.cubic", "instrument.roll_backlash", "damping.vortex_history"] {
        let off = error_deg(id, 0.0) - 1.0;
        assert!(off.abs() < 0.02, "{id}: {off} beyond the noise");
    }
    assert!(error_deg("restoring.cubic", SCATTER) > 1.05, "it knows the scatter");
    assert!(error_deg("tank.residual_wave", 0.0) > 1.2, "it knows the waves of the day");
}

#[test]
fn the_true_model_learns_from_the_other_runs_that_a_day_damps_by_a_tenth_more() {
    let mut campaign = Campaign::draw(&asked(RunSet::Speeds, &["restoring.cubic"], 2.0, 1));
    campaign.passes.iter_mut().for_each(|pass| pass.scatter = [1.1; 2]);
    let off = planned_error_deg(&campaign) / ROLL_NOISE_RAD.to_degrees() - 1.0;
    assert!(off.abs() < 0.02, "{off} beyond the noise");
}

#[test]
fn the_program_finds_and_identifies_the_runs_of_a_clean_campaign() {
    for set in [RunSet::Rest, RunSet::Speeds, RunSet::Forced] {
        let campaign = Campaign::draw(&asked(set, &[], 1.0, 0));
        let place = tempfile::tempdir().expect("a place for a campaign");
        let played = play(&campaign, place.path());
        assert!(!played.truth.starts_with(&played.folder), "the truth lies in the folder");
        let told = rolltank(&played.folder, &["identify", ".", "--json"]);
        let found: Value = serde_json::from_str(&told.out).expect("JSON");
        let truth = truth(&campaign);
        let runs = found["runs"].as_array().expect("runs");
        let true_runs = truth["runs"].as_array().expect("runs");
        assert_eq!(runs.len(), true_runs.len(), "{}: {}", set.name(), told.err);
        for (run, truth) in runs.iter().zip(true_runs) {
            assert_eq!(run["kind"], truth["kind"]);
            for key in ["b1_per_s", "b3_s"] {
                let number = |value: &Value| value.as_f64().expect("a number");
                let off = number(&run[key]["mean"]) - number(&truth[key]);
                // One in 15 000 draws of a normal is beyond four standard deviations.
                let allowed = 4.0 * number(&run[key]["sd"]);
                assert!(off.abs() < allowed, "{}: {key} off by {off} in {run}", set.name());
            }
        }
    }
}
