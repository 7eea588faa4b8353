//! The uncertainty budget of the damping, source by source.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table, text_cell};
use crate::report::number::{UNKNOWN, fixed, significant};
use crate::run::RunKind;
use crate::uncertainty::{self, Budget, EQUATIONS};

/// A column of a source: heading, type, and what the budget says of it.
type Source = (&'static str, &'static str, fn(&Budget) -> Option<f64>);

const DECAYS: [Source; 5] = [
    ("Noise", "A", |budget| Some(budget.noise_per_s)),
    ("Digitiser", "B", |budget| budget.digitiser_per_s),
    ("Run to run", "A", |budget| budget.run_to_run_per_s),
    ("Clock", "B", |budget| budget.clock_per_s),
    ("Roll gain", "B", |budget| budget.roll_gain_per_s),
];

const FORCED_RUNS: [Source; 7] = [
    ("Noise", "A", |budget| Some(budget.noise_per_s)),
    ("Run to run", "A", |budget| budget.run_to_run_per_s),
    ("Clock", "B", |budget| budget.clock_per_s),
    ("Skew", "B", |budget| budget.skew_per_s),
    ("Roll gain", "B", |budget| budget.roll_gain_per_s),
    ("Force gain", "B", |budget| budget.force_gain_per_s),
    ("GM", "B", |budget| budget.gm_per_s),
];

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let all = uncertainty::budgets(page.campaign, page.results);
    if all.is_empty() {
        return None;
    }
    let (decays, forced): (Vec<&Budget>, Vec<&Budget>) =
        all.iter().partition(|budget| budget.kind == RunKind::Decay.name());
    let equations: Vec<Markup> = EQUATIONS
        .iter()
        .map(|(source, kind, equation)| {
            html! { (text_cell(source)) (text_cell(kind)) (text_cell(equation)) }
        })
        .collect();
    let mut left_out: Vec<&str> = all.iter().flat_map(|budget| budget.left_out.clone()).collect();
    left_out.sort_unstable();
    left_out.dedup();
    Some(section(
        "uncertainty",
        "Uncertainty budget",
        &html! {
            @if !decays.is_empty() { (of_kind("budget-table", "decays", &decays, &DECAYS)) }
            @if !forced.is_empty() {
                (of_kind("forced-budget-table", "forced runs", &forced, &FORCED_RUNS))
            }
            @if !left_out.is_empty() {
                p.note {
                    "Where a dash stands nothing is known of the source, it is not in the sum, and "
                    "without the scatter from run to run the sum is a lower bound (≥): "
                    (left_out.join(", ")) ". What no record tells is given in [uncertainty] of "
                    "campaign.toml."
                }
            }
            (table(
                "budget-equations",
                "Sources, after the GUM (JCGM 100:2008) and ITTC 7.5-02-01-01.",
                &[("Source", ""), ("Type", ""), ("Standard uncertainty", "")],
                &equations,
            ))
        },
    ))
}

fn of_kind(id: &str, runs: &str, budgets: &[&Budget], sources: &[Source]) -> Markup {
    let mut columns = vec![
        ("Condition", ""),
        ("Fr", "–"),
        ("ω", "rad/s"),
        ("A", "deg"),
        ("n", ""),
        ("b_{eq}", "1/s"),
    ];
    columns.extend(sources.iter().map(|(source, kind, _)| (*source, *kind)));
    columns.extend([("u", "1/s"), ("U b_{eq}", "%"), ("U B̂₄₄", "%")]);
    let caption = format!(
        "Standard uncertainties of the mean b_{{eq}} of n {runs} at roll amplitude A in 1/s, type \
         A or B, u all of them together; U = k u as a share of the value, k for 95 % with the \
         effective degrees of freedom."
    );
    let rows: Vec<Markup> = budgets.iter().map(|budget| row(budget, sources)).collect();
    table(id, &caption, &columns, &rows)
}

fn row(budget: &Budget, sources: &[Source]) -> Markup {
    let known = |u: Option<f64>| u.map_or_else(|| UNKNOWN.to_owned(), |u| significant(u, 2));
    // A scatter that nobody has seen is the largest source in most tanks.
    let bound = if budget.run_to_run_per_s.is_none() { "≥ " } else { "" };
    let expanded = |share: f64| format!("{bound}{}", significant(100.0 * share, 2));
    html! {
        td { (budget.condition) }
        (number_cell(&fixed(budget.froude, 3)))
        (number_cell(&significant(budget.frequency_rad_s, 3)))
        (number_cell(&fixed(budget.amplitude_deg, 0)))
        (number_cell(&budget.n_runs.to_string()))
        (number_cell(&significant(budget.damping_per_s, 4)))
        @for (_, _, of) in sources { (number_cell(&known(of(budget)))) }
        (number_cell(&known(Some(budget.combined_per_s))))
        (number_cell(&expanded(budget.expanded_share)))
        (number_cell(&expanded(budget.b44_expanded_share)))
    }
}
