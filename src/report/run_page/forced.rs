//! What a forced run says beside its damping law (4.5).

use maud::{Markup, html};

use super::RunPage;
use crate::report::document::{estimate_cell, number_cell, section, table, text_cell};
use crate::report::number::{significant, standard_deviation};
use crate::roll::damping::cubic_weight;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let forced = page.identification().forced.as_ref()?;
    let units = page.field_units();
    let degree = 1.0_f64.to_degrees();
    let work = forced.work_damping_n_m_s;
    let rows = [
        ("ω", "frequency of the excitation", "rad/s", forced.frequency_rad_s),
        ("A₁", "roll amplitude", "deg", forced.roll_amplitude_rad.scaled(degree)),
        ("M_{a}", "amplitude of the exciting moment", "N m", forced.moment_amplitude_n_m),
        ("ε", "phase by which the moment leads the roll", "deg", forced.phase_rad.scaled(degree)),
        ("I + ΔI", "(K A₁ − M_{a} cos ε)/(ω² A₁)", "kg m²", units.inertia_kg_m2()),
        ("(I+ΔI)/(m B²)", "the same, B the beam", "–", units.inertia_over_mass_beam_squared()),
        ("max |U|", "peak of |U| per cycle", "rad/s²", forced.peak_moment_per_s2),
        ("B_{eq}", "work per cycle over π ω A₁²", "N m s", work),
        ("B̂₄₄", "the same, non-dimensional", "–", work.scaled(units.b44_hat_per_n_m_s())),
    ];
    let rows: Vec<_> = rows
        .iter()
        .map(|(symbol, meaning, unit, value)| {
            html! {
                (text_cell(symbol)) (text_cell(meaning)) td.number { (unit) }
                (estimate_cell(Some(value))) (number_cell(&standard_deviation(value)))
            }
        })
        .collect();
    let columns =
        [("Symbol", ""), ("Meaning", ""), ("Unit", ""), ("Mean and 95 % interval", ""), ("sd", "")];
    let caption = "Response to the excitation. B_{eq} from the work per cycle uses no damping law.";
    let body = html! {
        (table("forced-table", caption, &columns, &rows))
        @if let Some(skew) = &page.identification().skew {
            @let amplitude_rad = forced.roll_amplitude_rad.mean;
            @let weight = cubic_weight(forced.frequency_rad_s.mean, amplitude_rad);
            p.note {
                "By the stated bounds of their clocks the time between roll and moment has a "
                "standard uncertainty of " (significant(1e3 * skew.sd_s, 2)) " ms. That is "
                (significant(skew.damping_sd_per_s(weight), 2)) " 1/s of the standard deviation "
                "of b" sub { "eq" } " at this amplitude; a longer run makes it no less."
            }
        }
    };
    Some(section("forced", "Forced response", &body))
}
