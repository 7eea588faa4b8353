//! How soon after its last sample a run's report, provisional or final, is on the disk.

use std::path::Path;

use super::speed::Figure;
use crate::live::{self, LiveError};
use crate::tank::{Action, Scenario};

/// Seconds of the tank in one second; what the computer takes is told in the world's time, what it
/// takes to know that a run has ended in the tank's.
const SPEED: f64 = 4.0;

/// Ends that differ by less are alike [s].
const ALIKE_S: f64 = 0.02;

/// Latency from the last sample of a run to the first report on disk that holds it; from the sample
/// by which it is known to have ended to its own page, how long after the last sample of the run
/// that one comes, and both together; and how provisional and final reports agree.
///
/// # Errors
/// [`LiveError`] of daemon or tank.
pub fn report_latency(folder: &Path) -> Result<Vec<Figure>, LiveError> {
    let mut scenario = Scenario::builtin("short-day").unwrap_or_else(|| unreachable!("built in"));
    // Decays at rest and at speed, and forced runs with the many that follow each other closely.
    let is_forced =
        |action: &Action| matches!(action, Action::Forced { .. } | Action::ForcedIrregular { .. });
    let mut n_forced = 0;
    let bare = scenario.passes[0].condition.clone();
    scenario.passes.retain(|pass| {
        n_forced += usize::from(pass.actions.iter().any(is_forced));
        pass.condition == bare && n_forced <= 3
    });
    let ended = live::virtual_day(&scenario, 1, folder, (SPEED, None), &mut |_| {})?;
    let runs = ended.status.runs;
    let known_after_s = runs.known_after_s;
    let in_all_s: Vec<f64> =
        runs.latencies_s.iter().zip(&known_after_s).map(|(a, b)| a + b).collect();
    let first_s = runs.told_before.iter().map(|before| before.first_after_s).collect();
    let mut all: Vec<Figure> = [
        ("from the last sample of a run to the first report on the disk that holds it", first_s),
        (
            "from the sample by which a run's end is known to its final report on the disk",
            runs.latencies_s,
        ),
        ("from the last sample of a run to the one by which its end is known", known_after_s),
        ("from the last sample of a run to its final report on the disk", in_all_s),
    ]
    .into_iter()
    .flat_map(|(name, times_s)| figures(name, times_s))
    .collect();
    let before = &runs.told_before;
    let first: Vec<_> =
        before.iter().map(|of| (of.first_ends_later_s, of.first_moved_sd)).collect();
    let last: Vec<_> = before.iter().map(|of| (of.last_ends_later_s, of.last_moved_sd)).collect();
    all.extend(agreement("first report that holds a run", &first));
    all.extend(agreement("last provisional report of a run", &last));
    Ok(all)
}

/// How often some provisional reports end where the final one does, and how far their damping lies
/// from its.
fn agreement(name: &str, reports: &[(Option<f64>, Option<f64>)]) -> [Figure; 2] {
    let n_runs = reports.len();
    let ends_s: Vec<f64> = reports.iter().filter_map(|(later_s, _)| *later_s).collect();
    let n_alike = ends_s.iter().filter(|later_s| later_s.abs() < ALIKE_S).count();
    let mut moved: Vec<f64> =
        reports.iter().filter_map(|(_, moved)| *moved).map(f64::abs).collect();
    moved.sort_by(f64::total_cmp);
    let worst = moved.last().copied().unwrap_or(f64::NAN);
    let median = moved.get(moved.len() / 2).copied().unwrap_or(f64::NAN);
    [
        Figure {
            name: format!("{name}: provisional of {n_runs}, ending where the final one does"),
            value: format!("{}, {n_alike}", ends_s.len()),
        },
        Figure {
            name: format!("{name}: b_eq at 5 deg from the final one, median and worst"),
            value: format!("{median:.2} and {worst:.2} of its standard deviation"),
        },
    ]
}

/// Median and worst of some times.
fn figures(name: &str, mut times_s: Vec<f64>) -> [Figure; 2] {
    times_s.sort_by(f64::total_cmp);
    let told = |which: &str, time_s: Option<&f64>| Figure {
        name: format!("{name}, {which} of {} runs", times_s.len()),
        value: time_s.map_or("none".to_owned(), |time_s| format!("{:.0} ms", 1e3 * time_s)),
    };
    [told("median", times_s.get(times_s.len() / 2)), told("worst", times_s.last())]
}
