//! Inertia against frequency of excitation (Fig. 15).

use maud::{Markup, html};

use super::{CampaignPage, groups};
use crate::report::document::section;
use crate::report::figure::Axis;
use crate::report::number::fixed;
use crate::results::FROUDE_APART;

/// Least width of the axis over the largest value: smaller differences are no trend.
const WIDTH: f64 = 0.1;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let figures: Vec<_> = page
        .conditions()
        .into_iter()
        .enumerate()
        .filter_map(|(index, condition)| {
            let points: Vec<_> = page
                .forced_of(condition)
                .into_iter()
                .map(|(run, forced)| {
                    let i = page.field_units(run).inertia_over_mass_beam_squared();
                    (run.froude, (forced.frequency_rad_s.mean, i.mean, i.lo95, i.hi95))
                })
                .collect();
            let largest = points.iter().map(|(_, point)| point.1).fold(0.0, f64::max);
            let y = Axis::new("(I+ΔI)/(m B²) [–]").at_least(WIDTH * largest);
            let figure = groups::figure(
                format!("inertia-{}", index + 1),
                &format!("Inertia against frequency: {condition}"),
                (Axis::new("frequency of excitation ω [rad/s]"), y),
                &groups::by_value(points.clone(), FROUDE_APART),
                |froude| format!("Fr {}", fixed(froude, 2)),
            );
            (!points.is_empty()).then(|| {
                figure.caption(
                    "From (4.5), over mass times beam squared. The scale spans a tenth of the \
                     value or more.",
                )
            })
        })
        .collect();
    (!figures.is_empty()).then(|| {
        section(
            "inertia",
            "Inertia from forced runs",
            &html! { @for figure in &figures { (figure.markup()) } },
        )
    })
}
