//! Peak of |U| against frequency, then against Froude number (Figs. 18 and 19).

use maud::{Markup, html};

use super::{CampaignPage, groups};
use crate::report::document::section;
use crate::report::figure::{Axis, Figure};
use crate::report::number::fixed;
use crate::results::FROUDE_APART;

/// Frequencies further apart than this [rad/s] were meant to differ.
const FREQUENCY_APART_RAD_S: f64 = 0.05;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let figures: Vec<_> = page
        .conditions()
        .into_iter()
        .enumerate()
        .flat_map(|(index, condition)| figures(page, index + 1, condition))
        .collect();
    (!figures.is_empty()).then(|| {
        section(
            "peak-moment",
            "Peak moment of forced runs",
            &html! { @for figure in &figures { (figure.markup()) } },
        )
    })
}

fn figures(page: &CampaignPage, number: usize, condition: &str) -> Vec<Figure> {
    let points: Vec<_> = page
        .forced_of(condition)
        .into_iter()
        .map(|(run, forced)| (run.froude, forced.frequency_rad_s.mean, forced.peak_moment_per_s2))
        .collect();
    if points.is_empty() {
        return Vec::new();
    }
    let against_frequency: Vec<_> = points
        .iter()
        .map(|&(froude, w, peak)| (froude, (w, peak.mean, peak.lo95, peak.hi95)))
        .collect();
    let against_froude: Vec<_> = points
        .iter()
        .map(|&(froude, w, peak)| (w, (froude, peak.mean, peak.lo95, peak.hi95)))
        .collect();
    let peak = || Axis::new("max |U| [rad/s²]").holding(0.0);
    vec![
        groups::figure(
            format!("peak-frequency-{number}"),
            &format!("Peak moment against frequency: {condition}"),
            (Axis::new("frequency of excitation ω [rad/s]"), peak()),
            &groups::by_value(against_frequency, FROUDE_APART),
            |froude| format!("Fr {}", fixed(froude, 2)),
        )
        .caption("Peak of |U| per cycle; compare runs of equal roll amplitude only."),
        groups::figure(
            format!("peak-froude-{number}"),
            &format!("Peak moment against Froude number: {condition}"),
            (Axis::new("Froude number Fr [–]"), peak()),
            &groups::by_value(against_froude, FREQUENCY_APART_RAD_S),
            |w| format!("ω {} rad/s", fixed(w, 2)),
        )
        .caption("The same runs, joined by frequency."),
    ]
}
