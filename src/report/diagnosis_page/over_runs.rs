//! How much each run leaves unexplained, against Froude number, frequency and run order.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::diagnosis::Unexplained;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, Shape};

/// Name, label of the axis, and place of a run on it.
type View = (&'static str, &'static str, fn(&Unexplained) -> f64);

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let pairs = page.worst_first();
    if pairs.len() < 2 {
        return None;
    }
    let views: [View; 3] = [
        ("Froude number", "Froude number Fr [–]", |run| run.froude),
        ("frequency", "frequency of rolling [rad/s]", |run| run.frequency_rad_s),
        ("run order", "place in the order of runs", |run| run.order as f64 + 1.0),
    ];
    let figures = views.iter().enumerate().map(|(i, (name, label, x))| {
        let share = |left: &Unexplained| 100.0 * left.share_of_damping;
        let places: Vec<f64> = pairs.iter().map(|(before, _)| x(before)).collect();
        let before: Vec<f64> = pairs.iter().map(|(before, _)| share(before)).collect();
        let after: Vec<f64> = pairs.iter().map(|(_, after)| share(after)).collect();
        let open = Ink::new(Hue::Vermillion).shaped(Shape::OpenCircle).named("before");
        let mut panel = Panel::new(Axis::new("share of the damping moment [%]").holding(0.0))
            .height(150)
            .points(&places, &before, open);
        if page.is_extended() {
            panel = panel.points(&places, &after, Ink::new(Hue::Blue).named("after"));
        }
        let title = format!("Unexplained share against {name}");
        Figure::new(format!("share-{i}"), title, Axis::new(*label)).panel(panel).markup()
    });
    Some(section("over-runs", "Where it lives", &html! { @for figure in figures { (figure) } }))
}
