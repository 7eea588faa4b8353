//! How soon after its last sample a run's report is on the disk, measured at a virtual tank.

use std::path::Path;

use super::speed::Figure;
use crate::live::{self, LiveError};
use crate::tank::{Action, Scenario};

/// Seconds of the tank in one second; what the computer takes is told in the world's time, what it
/// takes to know that a run has ended in the tank's.
const SPEED: f64 = 10.0;

/// Latency from the sample by which a run is known to have ended to its page on the disk, how long
/// after the last sample of the run that one comes, and both together.
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
    Ok([
        (
            "from the sample by which a run's end is known to its report on the disk",
            runs.latencies_s,
        ),
        ("from the last sample of a run to the one by which its end is known", known_after_s),
        ("from the last sample of a run to its report on the disk", in_all_s),
    ]
    .into_iter()
    .flat_map(|(name, times_s)| figures(name, times_s))
    .collect())
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
