//! What the base model says of the damping, and what the extended one does.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::diagnosis::{Bias, Change};
use crate::report::document::{estimate_cell, section, table};
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, Shape};

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    if !page.is_extended() || page.diagnosis.bias.is_empty() {
        return None;
    }
    let rows: Vec<Markup> = page.diagnosis.bias.iter().flat_map(rows).collect();
    let columns = [("Condition", ""), ("Coefficient", ""), ("Before", ""), ("After", "")];
    let caption = "Coefficients of the law fitted to all runs together, by the simulation as it \
                   was and as it is extended: the difference is the bias that the old model had.";
    let drawn = html! {
        (figure("bias-b0", "Linear damping at rest", "b₀ [1/s]", page, |b| Some(b.b1_per_s)))
        (figure("bias-b3", "Cubic damping", "b₃ [s]", page, |b| Some(b.b3_s)))
        @if page.diagnosis.bias.iter().any(|bias| bias.kappa.is_some()) {
            (figure("bias-kappa", "Speed coefficient", "κ [–]", page, |b| b.kappa))
        }
    };
    Some(section(
        "bias",
        "Bias of the damping",
        &html! { (table("bias-table", caption, &columns, &rows)) (drawn) },
    ))
}

fn rows(bias: &Bias) -> Vec<Markup> {
    let row = |(i, (symbol, change)): (usize, (&str, Change))| {
        html! {
            td { @if i == 0 { (bias.condition) } }
            td { (symbol) }
            (estimate_cell(Some(&change.before)))
            (estimate_cell(Some(&change.after)))
        }
    };
    [("b₀ [1/s]", Some(bias.b1_per_s)), ("b₃ [s]", Some(bias.b3_s)), ("κ [–]", bias.kappa)]
        .into_iter()
        .filter_map(|(symbol, change)| Some((symbol, change?)))
        .enumerate()
        .map(row)
        .collect()
}

/// One coefficient of all conditions, before and after side by side.
fn figure(
    id: &str,
    title: &str,
    label: &str,
    page: &DiagnosisPage,
    of: fn(&Bias) -> Option<Change>,
) -> Markup {
    let changes: Vec<Change> = page.diagnosis.bias.iter().filter_map(of).collect();
    let bars = |side: f64, end: fn(&Change) -> crate::inverse::estimate::Estimate| -> Vec<_> {
        let bar = |(i, change): (usize, &Change)| {
            let e = end(change);
            (i as f64 + 1.0 + side, e.mean, e.lo95, e.hi95)
        };
        changes.iter().enumerate().map(bar).collect()
    };
    let before = Ink::new(Hue::Vermillion).shaped(Shape::OpenCircle).named("before");
    let panel = Panel::new(Axis::new(label).holding(0.0))
        .height(150)
        .error_bars(&bars(-0.1, |c| c.before), before)
        .error_bars(&bars(0.1, |c| c.after), Ink::new(Hue::Blue).named("after"));
    let names: Vec<&str> = page.diagnosis.bias.iter().map(|b| b.condition.as_str()).collect();
    let wide = Axis::new("condition").limited(0.5, names.len() as f64 + 0.5);
    Figure::new(id, title, wide)
        .caption(format!("Conditions in order: {}.", names.join(", ")))
        .panel(panel)
        .markup()
}
