//! The table of forced runs.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{estimate_cell, number_cell, run_link, section, table};
use crate::report::number::{fixed, mean};

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let degree = 1.0_f64.to_degrees();
    let rows: Vec<_> = page
        .conditions()
        .into_iter()
        .flat_map(|condition| page.forced_of(condition))
        .map(|(run, forced)| {
            let units = page.field_units(run);
            html! {
                td { a href=(run_link(&run.id)) { (run.id) } }
                (number_cell(&fixed(run.froude, 3)))
                (number_cell(&mean(&forced.frequency_rad_s)))
                (number_cell(&mean(&forced.roll_amplitude_rad.scaled(degree))))
                (number_cell(&mean(&forced.moment_amplitude_n_m)))
                (number_cell(&mean(&forced.phase_rad.scaled(degree))))
                (estimate_cell(Some(&units.inertia_kg_m2())))
                (estimate_cell(Some(&forced.peak_moment_per_s2)))
                (estimate_cell(Some(&forced.work_damping_n_m_s)))
            }
        })
        .collect();
    if rows.is_empty() {
        return None;
    }
    let columns = [
        ("Run", ""),
        ("Fr", "–"),
        ("ω", "rad/s"),
        ("A₁", "deg"),
        ("M_{a}", "N m"),
        ("ε", "deg"),
        ("I+ΔI", "kg m²"),
        ("max |U|", "rad/s²"),
        ("B_{eq}", "N m s"),
    ];
    let caption = "Forced runs; B_{eq} from the work per cycle at amplitude A₁.";
    Some(section(
        "forced-runs",
        "Forced runs",
        &table("forced-runs-table", caption, &columns, &rows),
    ))
}
