//! The run that ended last, in three lines.

use maud::{Markup, html};

use crate::report::campaign_page::CampaignPage;
use crate::report::document::typeset;
use crate::report::number::{estimate_within, fixed};
use crate::report::run_page::kind_name;

pub(super) fn part(page: &CampaignPage) -> Markup {
    let Some(run) = page.results.runs.last() else {
        return html! { p.note { "No run has been identified yet." } };
    };
    let units = page.field_units(run);
    let (name, damping) = match units.work_damping_per_s() {
        Some(damping) => ("at its own amplitude", Some(damping)),
        None => ("at 5 deg", units.at_comparison().map(|at| at.fitted_per_s)),
    };
    html! {
        p { b { (run.id) } ": " (kind_name(run.run.kind)) ", " (run.condition) }
        p.figure-of-merit {
            "Fr " b { (fixed(run.froude, 3)) }
            @if let Some(damping) = damping {
                ", b" sub { "eq" } " = " b { (typeset(&estimate_within(&damping, 4))) } " 1/s"
            }
        }
        @if damping.is_some() { p.note { "equivalent damping " (name) ", with its 95 % interval" } }
        @for remark in &run.identification.remarks { p.note { (remark) } }
    }
}
