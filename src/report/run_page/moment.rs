//! The inferred moment history with its band (Figs. 10 and 17b).

use maud::Markup;

use super::RunPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let moment = &page.identification().moment;
    if moment.time_s.is_empty() {
        return None;
    }
    let fit = &page.identification().damping;
    let law: Vec<_> = moment
        .roll_rate_rad_per_s
        .iter()
        .map(|rate| -(fit.b1_per_s.mean * rate + fit.b3_s.mean * rate.powi(3)))
        .collect();
    let panel = Panel::new(Axis::new("U [rad/s²]").holding(0.0))
        .height(260)
        .band(
            &moment.time_s,
            &moment.lo95_per_s2,
            &moment.hi95_per_s2,
            Ink::new(Hue::Blue).named("95 % credible band"),
        )
        .line(&moment.time_s, &moment.mean_per_s2, Ink::new(Hue::Blue).named("posterior mean"))
        .line(
            &moment.time_s,
            &law,
            Ink::new(Hue::Vermillion).dashed().named("−(b₁ φ′ + b₃ φ′³), fitted"),
        );
    let figure = Figure::new("moment", "Inferred moment per unit inertia", Axis::time())
        .caption("U = −B/(I+ΔI), inferred without assuming a damping law.")
        .panel(panel);
    Some(section("moment-section", "Inferred moment", &figure.markup()))
}
