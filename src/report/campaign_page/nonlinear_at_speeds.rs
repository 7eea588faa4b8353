//! How far damping rises with the roll at each speed, which a law of speed for `b1` alone hides.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, number_cell, section, table};
use crate::report::number::fixed;
use crate::uncertainty::{self, Rise};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let all = uncertainty::rises(page.results);
    if all.is_empty() {
        return None;
    }
    let rows: Vec<Markup> = all.iter().map(row).collect();
    let columns = [
        ("Condition", ""),
        ("Fr", "–"),
        ("Decays", ""),
        ("from A", "deg"),
        ("to A", "deg"),
        ("Rise of b_{eq}", "1/s"),
    ];
    let caption = "b_{eq} at a large roll amplitude less that at a small one, from the half cycles \
                   of the free decays that reach both, without a law: nil for linear damping, and \
                   alike at all speeds where speed changes the linear damping alone.";
    Some(section(
        "nonlinear-at-speeds",
        "Nonlinear damping against speed",
        &html! {
            (table("nonlinear-at-speeds-table", caption, &columns, &rows))
            p.note {
                "The intervals are of the noise within the runs. How far runs scatter comes on \
                 top: repeats tell."
            }
        },
    ))
}

fn row(rise: &Rise) -> Markup {
    let [from_deg, to_deg] = rise.amplitudes_deg;
    html! {
        td { (rise.condition) }
        (number_cell(&fixed(rise.froude, 3)))
        (number_cell(&rise.n_runs.to_string()))
        (number_cell(&fixed(from_deg, 0)))
        (number_cell(&fixed(to_deg, 0)))
        (estimate_cell(Some(&rise.rise_per_s)))
    }
}
