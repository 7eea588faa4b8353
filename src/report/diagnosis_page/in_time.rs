//! The unexplained moment of each run against time, before and after.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::diagnosis::Unexplained;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};
use crate::report::number::{fixed, significant};

/// Runs that are drawn; the others are in the table of what is left.
const DRAWN: usize = 6;

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let pairs = page.worst_first();
    let figures: Vec<Markup> =
        pairs.iter().take(DRAWN).enumerate().map(|(i, pair)| figure(page, i, pair)).collect();
    (!figures.is_empty()).then(|| {
        section(
            "unexplained-moment",
            "Unexplained moment",
            &html! {
                p {
                    "The moment that the simulation lacks, inferred from what it leaves of each \
                     record without assuming any form. Where the band holds nil, the simulation \
                     is right to within the noise."
                    @if pairs.len() > DRAWN {
                        " Drawn are the " (DRAWN) " of " (pairs.len())
                        " runs in which most is left, measured by the damping moment."
                    }
                }
                @for figure in &figures { (figure) }
            },
        )
    })
}

fn figure(page: &DiagnosisPage, i: usize, pair: &(&Unexplained, &Unexplained)) -> Markup {
    let (before, after) = *pair;
    let mut panel = drawn(before, "before", Hue::Vermillion);
    if page.is_extended() {
        panel = with(panel, after, "after", Hue::Blue);
    }
    let told = |left: &Unexplained| {
        format!(
            "{}\u{a0}% of the damping moment, {}\u{a0}% of the whole; the band excludes nil in \
             {}\u{a0}% of the record",
            significant(100.0 * left.share_of_damping, 2),
            significant(100.0 * left.share, 2),
            fixed(100.0 * left.outside, 0)
        )
    };
    let caption = if page.is_extended() {
        format!("Before: {}. After: {}.", told(before), told(after))
    } else {
        format!("Before: {}.", told(before))
    };
    Figure::new(format!("unexplained-{i}"), format!("Run {}", before.run), Axis::time())
        .caption(caption)
        .panel(panel)
        .markup()
}

fn drawn(left: &Unexplained, name: &str, hue: Hue) -> Panel {
    let panel = Panel::new(Axis::new("unexplained moment [N m]").holding(0.0));
    with(panel, left, name, hue)
}

fn with(panel: Panel, left: &Unexplained, name: &str, hue: Hue) -> Panel {
    let end = |times: f64| -> Vec<f64> {
        left.mean_n_m.iter().zip(&left.sd_n_m).map(|(m, sd)| m + times * sd).collect()
    };
    let (low, high) = (end(-1.96), end(1.96));
    panel.band(&left.time_s, &low, &high, Ink::new(hue).named(format!("{name}, 95 % band"))).line(
        &left.time_s,
        &left.mean_n_m,
        Ink::new(hue).named(name),
    )
}
