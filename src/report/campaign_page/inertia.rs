//! Inertia against frequency of excitation (Fig. 15).

use maud::Markup;

use super::{CampaignPage, forced_figures};
use crate::report::figure::Axis;

/// Least width of the axis over the largest value: smaller differences are no trend.
const WIDTH: f64 = 0.1;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let named = ("inertia", "Inertia from forced runs");
    forced_figures::section(page, named, |number, condition, runs| {
        let points: Vec<_> = runs
            .iter()
            .map(|(run, forced)| {
                let i = page.field_units(run).inertia_over_mass_beam_squared();
                (run.froude, (forced.frequency_rad_s.mean, i.mean, i.lo95, i.hi95))
            })
            .collect();
        let largest = points.iter().map(|(_, point)| point.1).fold(0.0, f64::max);
        let figure = forced_figures::against_frequency(
            format!("inertia-{number}"),
            &format!("Inertia against frequency: {condition}"),
            Axis::new("(I+ΔI)/(m B²) [–]").at_least(WIDTH * largest),
            points,
        );
        vec![figure.caption(
            "From (4.5), over mass times beam squared. The scale spans a tenth of the value or \
             more.",
        )]
    })
}
