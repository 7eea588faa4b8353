//! The least-squares solution beside the posterior mean (Fig. 9).

use maud::Markup;

use super::RunPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let identification = page.identification();
    let (moment, least_squares) = (&identification.moment, &identification.least_squares_per_s2);
    if least_squares.is_empty() {
        return None;
    }
    let figure =
        Figure::new("least-squares", "Moment by least squares, for comparison", Axis::time())
            .caption(
                "Solved without a prior, (2.5) amplifies the noise of the roll; the posterior mean \
                 is drawn to the same scale.",
            )
            .panel(
                Panel::new(Axis::new("U [rad/s²]").holding(0.0))
                    .line(
                        &moment.time_s,
                        least_squares,
                        Ink::new(Hue::Grey).wide(0.8).named("least squares"),
                    )
                    .line(
                        &moment.time_s,
                        &moment.mean_per_s2,
                        Ink::new(Hue::Blue).wide(1.8).named("posterior mean"),
                    ),
            );
    Some(section("least-squares-section", "Least-squares solution", &figure.markup()))
}
