//! Particulars of model, water, tank, exciter.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table, text_cell};
use crate::report::number::significant;
use crate::roll::exciting_moment::Arm;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let campaign = page.campaign;
    let (hull, water, tank) = (&campaign.hull, &campaign.water, &campaign.tank);
    let mut rows = vec![
        ("Length between perpendiculars L_{pp}", Some(hull.length_pp_m), "m"),
        ("Beam B", Some(hull.beam_m), "m"),
        ("Draft d", Some(hull.draft_m), "m"),
        ("Displaced volume ∇", Some(hull.displacement_m3), "m³"),
        ("Transverse metacentric height GM", Some(hull.gm_m), "m"),
        ("Water density ρ", Some(water.density_kg_m3), "kg/m³"),
        ("Gravity g", Some(water.gravity_m_s2), "m/s²"),
        ("Restoring coefficient K = ρ g ∇ GM", Some(hull.restoring_n_m_per_rad(water)), "N m/rad"),
        ("Mass m = ρ ∇", Some(water.density_kg_m3 * hull.displacement_m3), "kg"),
        ("Tank length", tank.length_m, "m"),
        ("Tank width", tank.width_m, "m"),
        ("Tank depth", tank.depth_m, "m"),
        ("Greatest carriage speed", tank.carriage_max_speed_m_s, "m/s"),
    ];
    let mut arm = "";
    if let Some(exciter) = &campaign.exciter {
        rows.push(("Moment arm of the exciter rod l", Some(exciter.moment_arm_m), "m"));
        arm = match exciter.arm {
            Arm::Constant => "Exciting moment: M = F l, the arm constant.",
            Arm::Cosine => "Exciting moment: M = F l cos φ, the rod staying vertical.",
            Arm::Rod { rod_length_m } => {
                rows.push(("Length of the exciter rod", Some(rod_length_m), "m"));
                "Exciting moment: force times its distance from the roll axis, the rod tilting."
            }
        };
    }
    let rows: Vec<_> = rows
        .into_iter()
        .filter_map(|(name, value, unit)| {
            let value = significant(value?, 4);
            Some(html! { (text_cell(name)) (number_cell(&value)) td.number { (unit) } })
        })
        .collect();
    let columns = [("Particular", ""), ("Value", ""), ("Unit", "")];
    Some(section(
        "particulars",
        "Particulars",
        &html! {
            (table("particulars-table", "Model scale.", &columns, &rows))
            @if !arm.is_empty() { p.note { (arm) } }
        },
    ))
}
