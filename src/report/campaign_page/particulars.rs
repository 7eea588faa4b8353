//! Particulars of model, water, tank, exciter.

use maud::{Markup, html};

use super::CampaignPage;
use crate::report::document::{number_cell, section, table, text_cell};
use crate::report::number::significant;
use crate::roll::exciting_moment::Arm;

#[expect(clippy::unnecessary_wraps, reason = "every part of a page has the same shape")]
pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let campaign = page.campaign;
    let (hull, water, tank) = (&campaign.hull, &campaign.water, &campaign.tank);
    let derived = |value: f64| Some(significant(value, 4));
    let given = |value: f64| Some(value.to_string());
    let mut rows = vec![
        ("Length between perpendiculars L_{pp}", given(hull.length_pp_m), "m"),
        ("Beam B", given(hull.beam_m), "m"),
        ("Draft d", given(hull.draft_m), "m"),
        ("Displaced volume ∇", given(hull.displacement_m3), "m³"),
        ("Transverse metacentric height GM", given(hull.gm_m), "m"),
        ("Water density ρ", given(water.density_kg_m3), "kg/m³"),
        ("Gravity g", given(water.gravity_m_s2), "m/s²"),
        (
            "Restoring coefficient K = ρ g ∇ GM",
            derived(hull.restoring_n_m_per_rad(water)),
            "N m/rad",
        ),
        ("Mass m = ρ ∇", derived(water.density_kg_m3 * hull.displacement_m3), "kg"),
        ("Tank length", tank.length_m.and_then(given), "m"),
        ("Tank width", tank.width_m.and_then(given), "m"),
        ("Tank depth", tank.depth_m.and_then(given), "m"),
        ("Greatest carriage speed", tank.carriage_max_speed_m_s.and_then(given), "m/s"),
    ];
    let mut arm = "";
    let turned = campaign.exciter.is_some_and(|exciter| exciter.force_sign < 0.0);
    if let Some(exciter) = &campaign.exciter {
        rows.push(("Moment arm of the exciter rod l", given(exciter.moment_arm_m), "m"));
        arm = match exciter.arm {
            Arm::Constant => "Exciting moment: M = F l, the arm constant.",
            Arm::Cosine => "Exciting moment: M = F l cos φ, the rod staying vertical.",
            Arm::Rod { rod_length_m } => {
                rows.push(("Length of the exciter rod", given(rod_length_m), "m"));
                "Exciting moment: force times its distance from the roll axis, the rod tilting."
            }
        };
    }
    let rows: Vec<_> = rows
        .into_iter()
        .filter_map(|(name, value, unit)| {
            Some(html! { (text_cell(name)) (number_cell(&value?)) td.number { (unit) } })
        })
        .collect();
    let columns = [("Particular", ""), ("Value", ""), ("Unit", "")];
    Some(section(
        "particulars",
        "Particulars",
        &html! {
            (table("particulars-table", "Model scale.", &columns, &rows))
            @if !arm.is_empty() {
                p.note {
                    (arm)
                    @if turned { " The force is recorded with the opposite sign and was turned." }
                }
            }
        },
    ))
}
