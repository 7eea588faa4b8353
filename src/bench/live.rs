//! How soon after its last sample a run's report is on the disk, measured at a virtual tank.

use std::path::Path;

use super::speed::Figure;
use crate::live::{self, LiveError};
use crate::tank::{Action, Scenario};

/// Seconds of the tank in one second; latencies are told in the world's time.
const SPEED: f64 = 10.0;

/// Latency from the sample by which a run is known to have ended to its page on the disk.
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
    let mut latencies_s = ended.status.runs.latencies_s;
    latencies_s.sort_by(f64::total_cmp);
    let figure = |name: &str, value: Option<&f64>| Figure {
        name: format!("{name}, {} runs at {SPEED} times the world's pace", latencies_s.len()),
        value: value.map_or("none".to_owned(), |latency_s| format!("{:.0} ms", 1e3 * latency_s)),
    };
    Ok(vec![
        figure(
            "from the sample that ends a run to its report on the disk, median",
            latencies_s.get(latencies_s.len() / 2),
        ),
        figure("the same, worst", latencies_s.last()),
    ])
}
