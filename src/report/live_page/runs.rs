//! Every run so far, each to be rejected, noted on or taken back; then what was not used.

use maud::{Markup, html};

use crate::report::campaign_page::CampaignPage;
use crate::report::document::{number_cell, run_link, section, short_estimate_cell, table};
use crate::report::number::fixed;
use crate::results::{IdentifiedRun, RejectedStretch};

pub(super) fn part(page: &CampaignPage) -> Markup {
    html! {
        (identified(page))
        (not_used(page))
    }
}

fn identified(page: &CampaignPage) -> Markup {
    // The newest is looked for first.
    let rows: Vec<Markup> = page.results.runs.iter().rev().map(|run| row(page, run)).collect();
    if rows.is_empty() {
        return html! { p.note { "No run has been identified yet." } };
    }
    let columns = [
        ("Run", ""),
        ("Kind", ""),
        ("Condition", ""),
        ("Fr", "–"),
        ("b_{eq}", "1/s"),
        ("b₁", "1/s"),
        ("Judge", ""),
    ];
    let caption =
        "Newest first. b_{eq}: of decays at 5 deg, of forced runs at their own amplitude.";
    section("runs", "Runs", &table("runs-table", caption, &columns, &rows))
}

fn row(page: &CampaignPage, run: &IdentifiedRun) -> Markup {
    let units = page.field_units(run);
    let at_five = units.at_comparison().map(|at| at.fitted_per_s);
    let damping = units.work_damping_per_s().or(at_five);
    html! {
        td.name { a href={ "/results/" (run_link(&run.id)) } { (run.id) } }
        td { (run.run.kind.name()) }
        td { (run.condition) }
        (number_cell(&fixed(run.froude, 3)))
        (short_estimate_cell(damping.as_ref()))
        (short_estimate_cell(Some(&run.identification.damping.b1_per_s)))
        td.buttons {
            button type="button" data-act="annotate" data-run=(run.id)
                aria-label={ "Note on run " (run.id) } { "Note" }
            button type="button" data-act="reject" data-run=(run.id)
                aria-label={ "Reject run " (run.id) } { "Reject" }
        }
    }
}

fn not_used(page: &CampaignPage) -> Markup {
    let (refused, changeovers) = page.results.refusals_and_changeovers();
    let row = |stretch: &&RejectedStretch| {
        html! {
            td.name {
                @if let Some(run) = &stretch.run {
                    a href={ "/results/" (run_link(run)) } { (run) }
                } @else { (stretch.recording) }
            }
            (number_cell(&fixed(stretch.start_s, 1)))
            (number_cell(&fixed(stretch.end_s, 1)))
            td { (stretch.reason) }
            td.buttons {
                @if let Some(run) = &stretch.run {
                    button type="button" data-act="accept" data-run=(run)
                        aria-label={ "Take again run " (run) } { "Take again" }
                }
            }
        }
    };
    let rows: Vec<Markup> = refused.iter().rev().map(row).collect();
    if rows.is_empty() && changeovers.is_empty() {
        return Markup::default();
    }
    let columns = [("Run or recording", ""), ("From", "s"), ("To", "s"), ("Reason", ""), ("", "")];
    let caption = "Refused by the run finder, by the identification, or by hand; newest first.";
    section(
        "not-used",
        "Not used",
        &html! {
            @if !rows.is_empty() { (table("not-used-table", caption, &columns, &rows)) }
            @if !changeovers.is_empty() {
                p.note { (changeovers.len()) " changeovers between excitations are in the report." }
            }
        },
    )
}
