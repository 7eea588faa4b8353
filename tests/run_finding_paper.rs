//! Every run of the paper's simulated campaign is found.

use rolltank::run::{Limits, Run, RunKind};
use rolltank::tank::{Scenario, TrueKind, TrueRun, simulate_pass};

use super::run_finding_scene::{LIMITS, find};

/// Half a roll period of the slowest excitation is 0.64 s; the second half of the smooth ramps of
/// 2 s between frequencies a few per cent apart may pass for steady.
fn is_found(run: &Run, truth: &TrueRun) -> bool {
    let forced = truth.kind == TrueKind::Forced;
    let early_s = if forced { 1.2 } else { 0.05 };
    let same_frequency = match (run.excitation_rad_s, truth.excitation_rad_s) {
        (Some(found), Some(truth)) => (found / truth - 1.0).abs() < 2e-3,
        (found, truth) => found == truth,
    };
    (run.kind == RunKind::Forced) == forced
        && (-early_s..0.64).contains(&(run.start_s - truth.start_s))
        && (run.end_s - truth.end_s).abs() < 0.79
        && same_frequency
}

#[test]
fn every_run_of_the_simulated_campaign_is_found_once() {
    let scenario = Scenario::builtin("paper").expect("the paper's campaign comes with the program");
    let mut misses = Vec::new();
    let mut n_runs = 0;
    for at in 0..scenario.pass_count() {
        let played = simulate_pass(&scenario, at, 1);
        let found = find(&played, Limits { carriage_max_speed_m_s: None, ..LIMITS });
        let truths = &played.truth.runs;
        n_runs += truths.len();
        let matches = found.runs.len() == truths.len()
            && found.runs.iter().zip(truths).all(|(run, truth)| is_found(run, truth));
        if !matches {
            println!("{}: {:#?}", played.name, played.truth.runs);
            found.print();
            misses.push(played.name);
        }
    }
    println!("{n_runs} runs");
    assert!(misses.is_empty(), "{misses:?} of {n_runs} runs");
}
