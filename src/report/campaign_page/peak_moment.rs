//! Peak of |U| against frequency, then against Froude number (Figs. 18 and 19).

use maud::Markup;

use super::{CampaignPage, forced_figures, groups};
use crate::report::figure::Axis;
use crate::report::number::fixed;

/// Frequencies further apart than this [rad/s] were meant to differ.
const FREQUENCY_APART_RAD_S: f64 = 0.05;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let named = ("peak-moment", "Peak moment of forced runs");
    forced_figures::section(page, named, |number, condition, runs| {
        let points = || {
            runs.iter().map(|(run, forced)| {
                (run.froude, forced.frequency_rad_s.mean, forced.peak_moment_per_s2)
            })
        };
        let against_frequency =
            points().map(|(froude, w, peak)| (froude, (w, peak.mean, peak.lo95, peak.hi95)));
        let against_froude =
            points().map(|(froude, w, peak)| (w, (froude, peak.mean, peak.lo95, peak.hi95)));
        let peak = || Axis::new("max |U| [rad/s²]").holding(0.0);
        vec![
            forced_figures::against_frequency(
                format!("peak-frequency-{number}"),
                &format!("Peak moment against frequency: {condition}"),
                peak(),
                against_frequency.collect(),
            )
            .caption("Peak of |U| per cycle; compare runs of equal roll amplitude only."),
            groups::figure(
                format!("peak-froude-{number}"),
                &format!("Peak moment against Froude number: {condition}"),
                (Axis::new("Froude number Fr [–]"), peak()),
                &groups::by_value(against_froude.collect(), FREQUENCY_APART_RAD_S),
                |w| format!("ω {} rad/s", fixed(w, 2)),
            )
            .caption("The same runs, joined by frequency."),
        ]
    })
}
