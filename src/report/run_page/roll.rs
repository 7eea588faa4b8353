//! The roll of the run, with the exciting moment of a forced run (Figs. 7 and 16).

use maud::Markup;

use super::{RunPage, degrees};
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let (roll, moment) = (&page.run.run.roll, &page.identification().moment);
    if roll.time_s.is_empty() {
        return None;
    }
    let forced = page.identification().forced.as_ref();
    let title =
        if forced.is_some() { "Measured roll and exciting moment" } else { "Measured roll" };
    let offset = page.identification().roll_offset_rad.mean;
    let smoothed: Vec<_> = moment.roll_rad.iter().map(|roll| roll + offset).collect();
    let panel = Panel::new(Axis::new("roll φ [deg]").holding(0.0))
        .line(&roll.time_s, &degrees(&roll.value), Ink::new(Hue::Blue).named("measured roll"))
        .line(
            &moment.time_s,
            &degrees(&smoothed),
            Ink::new(Hue::Orange).dashed().named("smoothed, zero offset added"),
        );
    let mut figure = Figure::new("roll", title, Axis::time()).panel(panel);
    if let Some(forced) = forced {
        let ink = Ink::new(Hue::Vermillion).named("exciting moment");
        figure =
            figure.panel(Panel::new(Axis::new("moment M [N m]").holding(0.0)).height(150).line(
                &forced.moment_time_s,
                &forced.moment_n_m,
                ink,
            ));
    }
    Some(section("roll-section", "Roll of the run", &figure.markup()))
}
