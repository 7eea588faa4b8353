//! Equivalent damping at the comparison amplitude against Froude number, all conditions together.

use maud::Markup;

use super::CampaignPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Ink, Panel};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let mut panel = Panel::new(Axis::new("b_{eq}(5 deg) [1/s]").holding(0.0)).height(260);
    let mut any = false;
    for (index, condition) in page.conditions().into_iter().enumerate() {
        let bars: Vec<_> = page
            .runs_of(condition)
            .filter_map(|run| {
                let at = page.field_units(run).at_comparison()?.fitted_per_s;
                Some((run.froude, at.mean, at.lo95, at.hi95))
            })
            .collect();
        if !bars.is_empty() {
            any = true;
            panel = panel.error_bars(&bars, Ink::of_series(index).named(condition));
        }
    }
    any.then(|| {
        let figure = Figure::new(
            "equivalent-damping",
            "Equivalent damping at 5 deg against Froude number",
            Axis::new("Froude number Fr [–]"),
        )
        .caption(
            "All runs, decays and forced; the value to compare between runs, since b₁ and b₃ trade \
             against each other.",
        )
        .panel(panel);
        section("equivalent-damping-section", "Equivalent damping", &figure.markup())
    })
}
