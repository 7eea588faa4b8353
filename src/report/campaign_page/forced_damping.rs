//! Equivalent damping of forced runs against frequency, from the work per cycle.

use maud::Markup;

use super::{CampaignPage, forced_figures};
use crate::report::figure::Axis;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let named = ("forced-damping", "Damping of forced runs");
    forced_figures::section(page, named, |number, condition, runs| {
        let points = runs.iter().map(|(run, forced)| {
            let b = forced.work_damping_n_m_s;
            (run.froude, (forced.frequency_rad_s.mean, b.mean, b.lo95, b.hi95))
        });
        let figure = forced_figures::against_frequency(
            format!("forced-damping-{number}"),
            &format!("Equivalent damping against frequency: {condition}"),
            Axis::new("B_{eq} [N m s]").holding(0.0),
            points.collect(),
        );
        vec![figure.caption(
            "Work of the exciting moment per cycle over π ω A₁², at the amplitude of each run, \
             without a damping law.",
        )]
    })
}
