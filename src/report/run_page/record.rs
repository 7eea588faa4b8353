//! The whole recording, with the run, its still stretch, what was rejected marked on it.

use maud::{Markup, html};

use super::{RunPage, degrees};
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};
use crate::report::number::fixed;
use crate::run::Series;

/// Least width of the axis of speed [m/s]; the noise of an encoder is far below.
const SPEED_WIDTH_M_S: f64 = 0.2;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let overview = page.overview?;
    if overview.roll.time_s.is_empty() {
        return None;
    }
    let rejected: Vec<_> =
        page.rejected.iter().filter(|stretch| stretch.recording == page.run.recording).collect();
    let mut figure = Figure::new("record", "The recording", Axis::time()).caption(
        "Lowest and highest value of each short stretch, as far as the recording was read when \
         the run ended; the campaign report lists what was not used.",
    );
    for (label, series, height, least) in [
        ("roll φ [deg]", &roll_in_degrees(&overview.roll), 170, 0.0),
        ("speed V [m/s]", &overview.speed, 90, SPEED_WIDTH_M_S),
        (drive_label(page), &overview.drive, 110, 0.0),
    ] {
        if series.time_s.is_empty() {
            continue;
        }
        let mut panel = Panel::new(Axis::new(label).at_least(least)).height(height);
        if let Some(still) = page.run.run.still {
            let ink = Ink::new(Hue::Green).named("still stretch");
            panel = panel.stretch(still.start_s, still.end_s, ink);
        }
        let ink = Ink::new(Hue::Sky).named("this run");
        panel = panel.stretch(page.run.run.start_s, page.run.run.end_s, ink);
        for stretch in &rejected {
            let ink = Ink::new(Hue::Vermillion).named("rejected");
            panel = panel.stretch(stretch.start_s, stretch.end_s, ink);
        }
        figure = figure.panel(panel.line(&series.time_s, &series.value, line()));
    }
    Some(section(
        "record-section",
        "The record",
        &html! {
            (figure.markup())
            @if !rejected.is_empty() {
                p.note { "Rejected in this recording:" }
                ul.note { @for stretch in &rejected {
                    li { (fixed(stretch.start_s, 2)) " to " (fixed(stretch.end_s, 2)) " s: "
                        (stretch.reason) }
                } }
            }
            @if !overview.notes.is_empty() {
                p.note { "Lost or mended while reading:" }
                ul.note { @for note in &overview.notes { li { (note) } } }
            }
        },
    ))
}

fn line() -> Ink {
    Ink::new(Hue::Black).wide(0.7)
}

fn roll_in_degrees(roll: &Series) -> Series {
    Series { time_s: roll.time_s.clone(), value: degrees(&roll.value) }
}

/// The drive is a force where an arm turns it into a moment, else the moment itself.
fn drive_label(page: &RunPage) -> &'static str {
    if page.campaign.exciter.is_some() { "force F [N]" } else { "moment M [N m]" }
}
