//! Coefficients of extinction, for those who write damping so.

use maud::{Markup, html};

use super::RunPage;
use crate::inverse::extinction::extinction;
use crate::report::document::{estimate_cell, section, table, text_cell};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let fitted = extinction(page.identification())?;
    let rows =
        [("p", "–", fitted.p), ("q", "1/deg", fitted.q_per_deg)].map(|(name, unit, value)| {
            html! { (text_cell(name)) (estimate_cell(Some(&value))) td.number { (unit) } }
        });
    let columns = [("Coefficient", ""), ("Value", ""), ("Unit", "")];
    let caption = format!(
        "Loss of amplitude over FULL cycles, Δφ/φ_{{m}} = p + q φ_{{m}}, φ_{{m}} in deg, fitted to \
         {} half cycles with their scatter; B₄₄ = 2 (p + q φ_{{a}}) (I+ΔI)/T.",
        fitted.n_half_cycles
    );
    Some(section(
        "extinction",
        "Coefficients of extinction",
        &table("extinction-table", &caption, &columns, &rows),
    ))
}
