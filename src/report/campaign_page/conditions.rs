//! The conditions tested: how many runs, at which speeds.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table, typeset};
use crate::report::number::{fixed, significant};
use crate::run::RunKind;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let conditions = page.conditions();
    if conditions.is_empty() {
        return None;
    }
    let rows: Vec<_> = conditions
        .iter()
        .map(|condition| {
            let runs: Vec<_> = page.runs_of(condition).collect();
            let count = |kind| runs.iter().filter(|run| run.run.kind == kind).count().to_string();
            let froude = span(runs.iter().map(|run| run.froude), |value| fixed(value, 3));
            let decays = runs.iter().filter(|run| run.run.kind == RunKind::Decay);
            let frequency =
                span(decays.map(|run| run.identification.natural_frequency_rad_s.mean), |value| {
                    fixed(value, 3)
                });
            let forced = page.forced_of(condition);
            let excitation =
                span(forced.iter().map(|(_, response)| response.frequency_rad_s.mean), |value| {
                    significant(value, 3)
                });
            html! {
                td { (condition) }
                (number_cell(&count(RunKind::Decay)))
                (number_cell(&count(RunKind::Forced)))
                (froude) (frequency) (excitation)
            }
        })
        .collect();
    let columns = [
        ("Condition", ""),
        ("Decays", ""),
        ("Forced runs", ""),
        ("Fr", "–"),
        ("ω_{n} in decays", "rad/s"),
        ("Excitation ω", "rad/s"),
    ];
    let caption = "Conditions, with the range of each quantity over the runs.";
    Some(section("conditions", "Conditions", &table("conditions-table", caption, &columns, &rows)))
}

fn span(values: impl Iterator<Item = f64>, text: impl Fn(f64) -> String) -> Markup {
    let (lo, hi) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let (lo, hi) = (typeset(&text(lo)), typeset(&text(hi)));
    html! { td.number { (lo) @if lo != hi { " to " (hi) } } }
}
