//! The gates of one run, in the order in which the run passes them.

mod before_waves_return;
mod calm_before_forced;
mod down_to_half_a_degree;
mod peaks;
mod rest_before_release;
mod sampling;
mod settled;
mod small_cycles;
mod steady_periods;

pub use settled::CALM_DEG;

use super::gate::Answer;
use crate::campaign::Campaign;
use crate::results::IdentifiedRun;

/// Whom a gate asks: a run in its campaign.
struct Asked<'a> {
    campaign: &'a Campaign,
    run: &'a IdentifiedRun,
}

/// Every gate; one that is not about a run of this kind gives no answer.
const GATES: [fn(&Asked<'_>) -> Option<Answer>; 9] = [
    rest_before_release::answer,
    calm_before_forced::answer,
    settled::answer,
    sampling::answer,
    peaks::answer,
    small_cycles::answer,
    down_to_half_a_degree::answer,
    steady_periods::answer,
    before_waves_return::answer,
];

/// What the procedure says of one run.
pub fn of_run(campaign: &Campaign, run: &IdentifiedRun) -> Vec<Answer> {
    GATES.iter().filter_map(|answer| answer(&Asked { campaign, run })).collect()
}
