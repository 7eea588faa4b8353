//! The observable of the inverse problem (Figs. 8 and 17a).

use maud::Markup;

use super::{RunPage, degrees};
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let moment = &page.identification().moment;
    if moment.observable_rad.is_empty() {
        return None;
    }
    let figure = Figure::new("observable", "Observable g of the inverse problem", Axis::time())
        .caption(
            "The measured roll less what it would be without damping: free motion from the initial \
             state and, in a forced run, the response to the measured moment, equation (2.4).",
        )
        .panel(Panel::new(Axis::new("g [deg]").holding(0.0)).height(170).line(
            &moment.time_s,
            &degrees(&moment.observable_rad),
            Ink::new(Hue::Blue),
        ));
    Some(section("observable-section", "Observable", &figure.markup()))
}
