//! The unexplained moment against roll, rate, acceleration and phase in the run it is largest in.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::diagnosis::Unexplained;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, Shape};

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let (before, after) = *page.worst_first().first()?;
    let degrees = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v.to_degrees()).collect() };
    let views = [
        ("roll", "roll φ [deg]", degrees(&before.roll_rad)),
        ("rate", "roll rate φ′ [deg/s]", degrees(&before.rate_rad_per_s)),
        ("acceleration", "roll acceleration φ″ [deg/s²]", degrees(&before.acceleration_rad_per_s2)),
        ("phase", "phase of roll, nil at a crest to starboard [deg]", degrees(&before.phase_rad())),
    ];
    let figures: Vec<Markup> =
        views.iter().map(|(name, label, x)| figure(page, name, label, x, before, after)).collect();
    Some(section(
        "against-motion",
        "Unexplained moment against the motion",
        &html! {
            p {
                "Run " (before.run) ". A moment that belongs to restoring follows the roll, one of \
                 damping the rate, one of inertia the acceleration; a moment that follows none of \
                 them comes from outside the model's roll."
            }
            @for figure in &figures { (figure) }
        },
    ))
}

fn figure(
    page: &DiagnosisPage,
    name: &str,
    label: &str,
    x: &[f64],
    before: &Unexplained,
    after: &Unexplained,
) -> Markup {
    let open = Ink::new(Hue::Vermillion).shaped(Shape::OpenCircle).named("before");
    let mut panel = Panel::new(Axis::new("unexplained moment [N m]").holding(0.0))
        .height(170)
        .points(x, &before.mean_n_m, open);
    if page.is_extended() && after.mean_n_m.len() == x.len() {
        panel = panel.points(x, &after.mean_n_m, Ink::new(Hue::Blue).named("after"));
    }
    Figure::new(format!("against-{name}"), format!("Against {name}"), Axis::new(label))
        .panel(panel)
        .markup()
}
