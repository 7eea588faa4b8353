//! Equivalent damping of forced runs against frequency, from the work per cycle.

use maud::{Markup, html};

use super::{CampaignPage, groups};
use crate::report::document::section;
use crate::report::figure::Axis;
use crate::report::number::fixed;
use crate::results::FROUDE_APART;

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
                    let b = forced.work_damping_n_m_s;
                    (run.froude, (forced.frequency_rad_s.mean, b.mean, b.lo95, b.hi95))
                })
                .collect();
            let y = Axis::new("B_{eq} [N m s]").holding(0.0);
            let figure = groups::figure(
                format!("forced-damping-{}", index + 1),
                &format!("Equivalent damping against frequency: {condition}"),
                (Axis::new("frequency of excitation ω [rad/s]"), y),
                &groups::by_value(points.clone(), FROUDE_APART),
                |froude| format!("Fr {}", fixed(froude, 2)),
            );
            (!points.is_empty()).then(|| {
                figure.caption(
                    "Work of the exciting moment per cycle over π ω A₁², at the amplitude of each \
                     run, without a damping law.",
                )
            })
        })
        .collect();
    (!figures.is_empty()).then(|| {
        section(
            "forced-damping",
            "Damping of forced runs",
            &html! { @for figure in &figures { (figure.markup()) } },
        )
    })
}
