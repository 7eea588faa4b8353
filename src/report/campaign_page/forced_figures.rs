//! Figures of forced runs, condition by condition.

use maud::{Markup, html};

use super::CampaignPage;
use super::groups::{self, Point};
use crate::inverse::identification::ForcedResponse;
use crate::report::document;
use crate::report::figure::{Axis, Figure};
use crate::report::number::fixed;
use crate::results::{FROUDE_APART, IdentifiedRun};

/// A run with its response.
pub(super) type Forced<'a> = (&'a IdentifiedRun, &'a ForcedResponse);

/// A section with the figures of every condition that has forced runs; `figures` is given the
/// number of the condition from 1 on, its name and its runs.
pub(super) fn section<'a>(
    page: &CampaignPage<'a>,
    (id, heading): (&str, &str),
    figures: impl Fn(usize, &str, &[Forced<'a>]) -> Vec<Figure>,
) -> Option<Markup> {
    let mut all = Vec::new();
    for (index, condition) in page.conditions().into_iter().enumerate() {
        let runs = page.forced_of(condition);
        if !runs.is_empty() {
            all.extend(figures(index + 1, condition, &runs));
        }
    }
    let drawn = html! { @for figure in &all { (figure.markup()) } };
    (!all.is_empty()).then(|| document::section(id, heading, &drawn))
}

/// Points `(Fr, (frequency, y, lo, hi))` against frequency, joined by Froude number.
pub(super) fn against_frequency(
    id: String,
    title: &str,
    y: Axis,
    points: Vec<(f64, Point)>,
) -> Figure {
    let x = Axis::new("frequency of excitation ω [rad/s]");
    let groups = groups::by_value(points, FROUDE_APART);
    groups::figure(id, title, (x, y), &groups, |froude| format!("Fr {}", fixed(froude, 2)))
}
