//! Runs that took no part in a fit are foretold as well as the true model foretells them.

use super::hidden_effects_are_named::{diagnosed, drawn_seed};
use super::hidden_tank::foretold::{rmse_deg, stretches};
use super::hidden_tank::plan::RunSet;

/// What the error of the extended model may exceed that of the true one by [-].
const MOST_EXCESS: f64 = 0.05;

/// Excess of the extended model's error over the true one's in a hull with bilge keels, or
/// without.
fn excess(set: RunSet, id: &str, with_keels: bool) -> f64 {
    let seed = 4 * (drawn_seed(id) / 4) + if with_keels { 3 } else { 0 };
    let (campaign, verdict) = diagnosed(set, &[id], 2.0, seed);
    assert_eq!(campaign.keels, with_keels);
    let told = &verdict.json["gain"]["held_out_rmse_deg"];
    let [before, after] = ["before", "after"].map(|when| told[when].as_f64().expect("a number"));
    assert!(after < before, "{id}: {before} to {after} deg");
    let runs = stretches(&verdict.json);
    assert_eq!(runs.len(), campaign.passes.len(), "{id}: each pass is one run");
    after / rmse_deg(&campaign, &runs).expect("runs are left") - 1.0
}

#[test]
fn decays_at_rest_are_foretold_as_by_the_true_model() {
    let excess = excess(RunSet::Rest, "damping.coulomb", false);
    assert!(excess < MOST_EXCESS, "beyond the true model by {excess}");
}

#[test]
fn decays_under_way_are_foretold_as_by_the_true_model() {
    let excess = excess(RunSet::Speeds, "restoring.speed", true);
    assert!(excess < MOST_EXCESS, "beyond the true model by {excess}");
}

#[test]
fn the_roll_that_a_rod_imposes_is_not_bent_to_a_moment_that_is_to_be_foretold() {
    let excess = excess(RunSet::Forced, "instrument.force_offset", true);
    assert!(excess < MOST_EXCESS, "beyond the true model by {excess}");
}
