//! The run simulated again with the fitted law (Figs. 13 and 17c).

use maud::Markup;

use super::{RunPage, degrees};
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};
use crate::report::number::significant;

/// Residual over noise above which a reader is told that more than noise is left.
const STRUCTURE: f64 = 1.5;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let again = &page.identification().resimulation;
    if again.time_s.is_empty() {
        return None;
    }
    let residual: Vec<_> = again
        .measured_rad
        .iter()
        .zip(&again.simulated_rad)
        .map(|(measured, simulated)| (measured - simulated).to_degrees())
        .collect();
    let noise = page.identification().roll_noise_rad.mean.to_degrees();
    let ratio = again.rmse_rad.to_degrees() / noise;
    let structure = if ratio > STRUCTURE {
        format!(
            " The residual is {} times the noise: the fitted model leaves a part of the motion \
             over.",
            significant(ratio, 2)
        )
    } else {
        String::new()
    };
    let caption = format!(
        "Residual rmse {} deg; the noise of the roll channel is estimated as {} deg.{structure}",
        significant(again.rmse_rad.to_degrees(), 3),
        significant(noise, 2)
    );
    let (measured, simulated) = (degrees(&again.measured_rad), degrees(&again.simulated_rad));
    let figure = Figure::new("resimulation", "Resimulated and measured roll", Axis::time())
        .caption(caption)
        .panel(
            Panel::new(Axis::new("roll φ [deg]").holding(0.0))
                .line(&again.time_s, &measured, Ink::new(Hue::Blue).wide(2.2).named("measured"))
                .line(
                    &again.time_s,
                    &simulated,
                    Ink::new(Hue::Vermillion).dashed().named("resimulated with the fitted law"),
                ),
        )
        .panel(
            Panel::new(Axis::new("residual [deg]").holding(0.0))
                .height(110)
                .line(
                    &again.time_s,
                    &residual,
                    Ink::new(Hue::Black).wide(0.8).named("measured less resimulated"),
                )
                .level(0.0, Ink::new(Hue::Grey).wide(0.8)),
        );
    Some(section("resimulation-section", "Resimulation", &figure.markup()))
}
