//! The damping at each Froude number tested, with its intervals: what the campaign was towed for.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{
    number_cell, run_link, section, short_estimate_cell, table, typeset,
};
use crate::report::number::{fixed, mean_within};
use crate::results::{IdentifiedRun, by_speed};
use crate::run::RunKind;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let conditions = page.conditions();
    if conditions.is_empty() {
        return None;
    }
    let any_forced = page.results.runs.iter().any(|run| run.run.kind == RunKind::Forced);
    let mut columns = vec![
        ("Fr", "–"),
        ("b_{eq}(5°)", "1/s"),
        ("B̂₄₄(5°)", "–"),
        ("ζ(5°)", "–"),
        ("b₁", "1/s"),
        ("b₃", "s"),
    ];
    let mut caption = "Free decays, with 95 % intervals below: damping at 5 deg as equivalent \
                       b_{eq}, as B̂₄₄, as ratio to critical ζ; coefficients of b₁ φ′ + b₃ φ′³."
        .to_owned();
    if any_forced {
        columns.push(("b_{eq}(A₁) forced", "1/s"));
        caption += " Beside them the forced runs at that speed, each at its own amplitude A₁: \
                    lowest to highest over their frequencies.";
    }
    columns.push(("Decay", ""));
    let rows: Vec<_> = conditions
        .into_iter()
        .flat_map(|condition| {
            let heading =
                html! { th.group scope="rowgroup" colspan=(columns.len()) { (condition) } };
            let speeds = by_speed(page.runs_of(condition).collect());
            std::iter::once(heading).chain(speeds.into_iter().flat_map(|runs| rows(page, &runs)))
        })
        .collect();
    let extrapolated = page.results.runs.iter().any(|run| {
        run.run.kind == RunKind::Decay
            && page.field_units(run).at_comparison().is_some_and(|at| at.extrapolated)
    });
    Some(section(
        "damping-at-speeds-section",
        "Damping at each Froude number",
        &html! {
            (table("damping-at-speeds", &caption, &columns, &rows))
            @if extrapolated {
                p.note { "† The decay did not reach 5 deg: the law is extrapolated." }
            }
        },
    ))
}

/// One row per decay; forced runs stand in the first, or alone where there is no decay.
fn rows(page: &CampaignPage, runs: &[&IdentifiedRun]) -> Vec<Markup> {
    let any_forced = page.results.runs.iter().any(|run| run.run.kind == RunKind::Forced);
    let forced = if any_forced { forced_cell(page, runs) } else { Markup::default() };
    let decays: Vec<_> = runs.iter().filter(|run| run.run.kind == RunKind::Decay).collect();
    if decays.is_empty() {
        let froude = runs.iter().map(|run| run.froude).sum::<f64>() / runs.len() as f64;
        return vec![html! {
            (number_cell(&fixed(froude, 3)))
            @for _ in 0..5 { (short_estimate_cell(None)) }
            (forced)
            td {}
        }];
    }
    let row = |(index, run): (usize, &&&IdentifiedRun)| {
        let units = page.field_units(run);
        let at = units.at_comparison();
        let damping = at.map(|at| at.fitted_per_s);
        html! {
            td.number {
                (typeset(&fixed(run.froude, 3)))
                @if at.is_some_and(|at| at.extrapolated) { " †" }
            }
            (short_estimate_cell(damping.as_ref()))
            (short_estimate_cell(damping.map(|b| units.b44_hat(b)).as_ref()))
            (short_estimate_cell(damping.map(|b| units.damping_ratio(b)).as_ref()))
            (short_estimate_cell(Some(&run.identification.damping.b1_per_s)))
            (short_estimate_cell(Some(&run.identification.damping.b3_s)))
            @if index == 0 { (forced) } @else if any_forced { td {} }
            td.name { a href=(run_link(&run.id)) { (run.id) } }
        }
    };
    decays.iter().enumerate().map(row).collect()
}

fn forced_cell(page: &CampaignPage, runs: &[&IdentifiedRun]) -> Markup {
    let mut forced: Vec<_> = runs
        .iter()
        .filter_map(|run| page.field_units(run).work_damping_per_s())
        .filter(|b| b.mean.is_finite())
        .collect();
    forced.sort_by(|a, b| a.mean.total_cmp(&b.mean));
    html! {
        @match forced.as_slice() {
            [] => { (short_estimate_cell(None)) }
            [only] => { (short_estimate_cell(Some(only))) }
            [lowest, .., highest] => {
                td.number.stacked {
                    (mean_within(lowest, 3)) " to " (mean_within(highest, 3))
                    span.interval { (forced.len()) " runs" }
                }
            }
        }
    }
}
