//! The coefficients with their intervals and the correlation of the law's two.

use std::f64::consts::PI;

use maud::{Markup, html};

use super::RunPage;
use crate::inverse::estimate::Estimate;
use crate::report::document::{estimate_cell, number_cell, section, table, text_cell, typeset};
use crate::report::notation;
use crate::report::number::{fixed, standard_deviation};

/// Caption of the first table.
const LAW: &str = "The damping law B/(I+ΔI) = b₁ φ′ + b₃ φ′³.";

/// Symbol, meaning, unit, value.
type Row = (&'static str, &'static str, &'static str, Estimate);

#[expect(clippy::unnecessary_wraps, reason = "every part of a page has the same shape")]
pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let columns =
        [("Symbol", ""), ("Meaning", ""), ("Unit", ""), ("Mean and 95 % interval", ""), ("sd", "")];
    let cells = |rows: Vec<Row>| -> Vec<Markup> {
        rows.iter()
            .map(|(symbol, meaning, unit, value)| {
                html! {
                    (text_cell(symbol)) (text_cell(meaning)) td.number { (unit) }
                    (estimate_cell(Some(value))) (number_cell(&standard_deviation(value)))
                }
            })
            .collect()
    };
    let correlation = page.identification().damping.correlation;
    let decimals = if correlation.abs() > 0.99 { 4 } else { 2 };
    let inseparable = correlation < -0.99;
    let correlation = fixed(correlation, decimals);
    Some(section(
        "coefficients",
        "Coefficients",
        &html! {
            (table("law", LAW, &columns, &cells(law(page))))
            p { "Posterior correlation of b₁ and b₃: " b { (typeset(&correlation)) }
                ". Near −1 the two trade against each other; " (notation::html("b_{eq}"))
                " at an amplitude inside the run is then known far better than either."
                @if inseparable {
                    b { " This run does not part b₁ from b₃: use "
                        (notation::html("b_{eq}")) " at its amplitude." }
                }
            }
            (table("motion", "Motion and channel.", &columns, &cells(motion(page))))
        },
    ))
}

fn law(page: &RunPage) -> Vec<Row> {
    let (identification, units) = (page.identification(), page.field_units());
    let fit = &identification.damping;
    let w = identification.natural_frequency_rad_s.mean;
    let a_half = fit.b1_per_s.scaled(PI / (2.0 * w));
    vec![
        ("b₁", "linear damping per unit inertia", "1/s", fit.b1_per_s),
        ("b₃", "cubic damping per unit inertia", "s", fit.b3_s),
        ("B₁", "linear damping moment", "N m s", units.moment(fit.b1_per_s)),
        ("B₃", "cubic damping moment", "N m s³", units.moment(fit.b3_s)),
        ("a", "extinction, half cycle: (π/2) b₁/ω_{n}", "–", a_half),
        (
            "c",
            "extinction, half cycle: (3π/8) ω_{n} b₃",
            "1/rad²",
            fit.b3_s.scaled(3.0 * PI / 8.0 * w),
        ),
    ]
}

fn motion(page: &RunPage) -> Vec<Row> {
    let identification = page.identification();
    let w = identification.natural_frequency_rad_s;
    let degrees = |angle_rad: Estimate| angle_rad.scaled(1.0_f64.to_degrees());
    let period = Estimate {
        mean: 2.0 * PI / w.mean,
        sd: 2.0 * PI * w.sd / w.mean.powi(2),
        lo95: 2.0 * PI / w.hi95,
        hi95: 2.0 * PI / w.lo95,
    };
    let inertia = page.field_units().inertia_kg_m2();
    vec![
        ("ω_{n}", "small-angle natural frequency", "rad/s", w),
        ("T_{n}", "natural period 2π/ω_{n}", "s", period),
        ("I + ΔI", "inertia with added inertia", "kg m²", inertia),
        ("φ(0)", "roll at the start", "deg", degrees(identification.initial_roll_rad)),
        (
            "φ′(0)",
            "rate at the start",
            "deg/s",
            degrees(identification.initial_roll_rate_rad_per_s),
        ),
        (
            "φ_{0}",
            "zero offset of the roll channel",
            "deg",
            degrees(identification.roll_offset_rad),
        ),
        ("σ", "noise of the roll channel", "deg", degrees(identification.roll_noise_rad)),
    ]
}
