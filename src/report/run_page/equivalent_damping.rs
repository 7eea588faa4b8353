//! Equivalent damping against amplitude: the law, the half cycles, the table.

use maud::{Markup, html};

use super::RunPage;
use crate::inverse::estimate::Estimate;
use crate::report::document::{estimate_cell, section, table};
use crate::report::field_units::fitted_equivalent_damping;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, SecondScale, Shape};

/// Points of the law's curve.
const N_LAW: u32 = 60;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let figure = figure(page);
    let rows = rows(page);
    if figure.is_none() && rows.is_empty() {
        return None;
    }
    let columns = [
        ("A", "deg"),
        ("b_{eq}", "1/s"),
        ("b_{eq} local", "1/s"),
        ("B_{eq}", "N m s"),
        ("B̂₄₄", "–"),
        ("ζ", "–"),
        ("Δφ/φ_{m} half cycle", "–"),
        ("N", "1/deg"),
    ];
    let caption = "Equivalent damping of all forms of law together, or of the half cycles where no \
                   law holds; the second b_{eq} is always theirs. For the full-cycle decrement \
                   (p–q) double the last but one; N is Bertin's, Δφ = N φ_{m}² a half cycle.";
    Some(section(
        "equivalent-damping-section",
        "Equivalent damping",
        &html! {
            @if let Some(figure) = figure { (figure.markup()) }
            @if !rows.is_empty() {
                (table("equivalent-damping-table", caption, &columns, &rows))
            }
            @if page.identification().equivalent_damping.iter().any(|at| at.extrapolated) {
                p.note { "† The run did not reach this amplitude: the law is extrapolated." }
            }
        },
    ))
}

fn rows(page: &RunPage) -> Vec<Markup> {
    let units = page.field_units();
    let all = &page.identification().equivalent_damping;
    all.iter()
        .map(|at| {
            let b = at.fitted_per_s;
            html! {
                td.number { (at.amplitude_deg) @if at.extrapolated { " †" } }
                (estimate_cell(Some(&b)))
                (estimate_cell(at.local_per_s.as_ref()))
                (estimate_cell(Some(&units.moment(b))))
                (estimate_cell(Some(&units.b44_hat(b))))
                (estimate_cell(Some(&units.damping_ratio(b))))
                (estimate_cell(Some(&units.half_cycle_decrement(b))))
                (estimate_cell(Some(&units.bertin_n_per_deg(b, at.amplitude_deg))))
            }
        })
        .collect()
}

fn figure(page: &RunPage) -> Option<Figure> {
    let identification = page.identification();
    let half_cycles = &identification.half_cycles;
    let roll = &identification.moment.roll_rad;
    let largest = half_cycles
        .iter()
        .map(|at| at.amplitude_rad)
        .chain(roll.iter().map(|roll| roll.abs()))
        .chain(identification.forced.iter().map(|forced| forced.roll_amplitude_rad.mean))
        .fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let w = identification.rolling_frequency_rad_s();
    let amplitude: Vec<_> =
        (0..=N_LAW).map(|k| largest * f64::from(k) / f64::from(N_LAW)).collect();
    let law: Vec<_> = amplitude
        .iter()
        .map(|&amplitude| fitted_equivalent_damping(&identification.damping, w, amplitude))
        .collect();
    let degrees = super::degrees(&amplitude);
    let local: Vec<_> = half_cycles
        .iter()
        .map(|at| (at.amplitude_rad.to_degrees(), at.equivalent_damping_per_s))
        .map(|(amplitude, b)| (amplitude, b.mean, b.lo95, b.hi95))
        .collect();
    let (lo, hi) = limits(&law, &local);
    let factor = page.field_units().b44_hat(Estimate::normal(1.0, 0.0)).mean;
    let panel = Panel::new(Axis::new("b_{eq} [1/s]").limited(lo, hi))
        .height(270)
        .second_scale(SecondScale { label: "B̂₄₄ [–]".to_owned(), factor })
        .band(&degrees, &ends(&law, |at| at.lo95), &ends(&law, |at| at.hi95), law_ink())
        .line(
            &degrees,
            &ends(&law, |at| at.mean),
            Ink::new(Hue::Vermillion).wide(1.8).named("law b₁ + ¾ (ω A)² b₃"),
        );
    let panel = with_measured(page, panel, &local);
    Some(
        Figure::new(
            "equivalent-damping",
            "Equivalent damping against amplitude",
            Axis::new("roll amplitude A [deg]").holding(0.0),
        )
        .caption(
            "Points are the energy lost from peak to peak of the posterior motion; bars that leave \
             the frame end at its edge. The cubic law is drawn up to the largest roll of the run, \
             with ω the frequency at which the model rolls.",
        )
        .panel(panel),
    )
}

/// Adds what is known without the law: half cycles, or the work per cycle of a forced run.
fn with_measured(page: &RunPage, mut panel: Panel, local: &[(f64, f64, f64, f64)]) -> Panel {
    if !local.is_empty() {
        let ink = Ink::new(Hue::Blue).shaped(Shape::OpenCircle);
        panel = panel.error_bars(local, ink.named("each half cycle, 95 % interval"));
    }
    let forced = page.identification().forced.as_ref();
    if let (Some(forced), Some(b)) = (forced, page.field_units().work_damping_per_s()) {
        let amplitude_deg = forced.roll_amplitude_rad.mean.to_degrees();
        let ink = Ink::new(Hue::Blue).named("work per cycle at A₁");
        panel = panel.error_bars(&[(amplitude_deg, b.mean, b.lo95, b.hi95)], ink);
    }
    panel
}

fn law_ink() -> Ink {
    Ink::new(Hue::Vermillion).named("95 % band of the law")
}

fn ends(law: &[Estimate], end: impl Fn(&Estimate) -> f64) -> Vec<f64> {
    law.iter().map(end).collect()
}

/// Holds the law, its band and every half-cycle mean of the better-known half, not every bar:
/// the last, smallest half cycles are known so badly that they would flatten the rest.
fn limits(law: &[Estimate], local: &[(f64, f64, f64, f64)]) -> (f64, f64) {
    let mut widths: Vec<_> = local.iter().map(|bar| bar.3 - bar.2).collect();
    widths.sort_by(f64::total_cmp);
    let usual = widths.get(widths.len() / 2).copied().unwrap_or(0.0);
    let known = local.iter().filter(|bar| bar.3 - bar.2 <= 2.0 * usual);
    let (lo, hi) = law
        .iter()
        .flat_map(|at| [at.lo95, at.hi95])
        .chain(known.flat_map(|bar| [bar.2, bar.3]))
        .filter(|value| value.is_finite())
        .fold((0.0_f64, 0.0_f64), |(lo, hi), value| (lo.min(value), hi.max(value)));
    (if lo < 0.0 { lo * 1.05 } else { 0.0 }, hi * 1.08)
}
