//! Frequency of each half cycle against its amplitude.

use maud::Markup;

use super::RunPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, Shape};
use crate::run::RunKind;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let half_cycles = &page.identification().half_cycles;
    if half_cycles.is_empty() || page.run.run.kind == RunKind::Forced {
        return None;
    }
    let w = page.identification().natural_frequency_rad_s;
    let amplitude: Vec<_> = half_cycles.iter().map(|at| at.amplitude_rad.to_degrees()).collect();
    let frequency: Vec<_> = half_cycles.iter().map(|at| at.frequency_rad_s).collect();
    let largest = amplitude.iter().copied().fold(0.0, f64::max);
    let panel = Panel::new(axis(page, &frequency))
        .height(180)
        .band(
            &[0.0, largest],
            &[w.lo95; 2],
            &[w.hi95; 2],
            Ink::new(Hue::Vermillion).named("95 % interval of ω_{n}"),
        )
        .line(
            &[0.0, largest],
            &[w.mean; 2],
            Ink::new(Hue::Vermillion).named("small-angle natural frequency ω_{n}"),
        )
        .points(
            &amplitude,
            &frequency,
            Ink::new(Hue::Blue).shaped(Shape::OpenCircle).named("each half cycle"),
        );
    let figure = Figure::new(
        "natural-frequency",
        "Frequency of each half cycle against its amplitude",
        Axis::new("roll amplitude A [deg]").holding(0.0),
    )
    .caption(
        "A trend with amplitude points to a restoring moment that is not linear. The scale holds \
         half cycles above ten times the noise; smaller ones may stand on its edge.",
    )
    .panel(panel);
    Some(section("natural-frequency-section", "Natural frequency", &figure.markup()))
}

/// Holds the half cycles whose crossings the noise hardly moves, not the last, smallest ones.
fn axis(page: &RunPage, frequency: &[f64]) -> Axis {
    let axis = Axis::new("frequency ω [rad/s]");
    let identification = page.identification();
    let w = identification.natural_frequency_rad_s;
    let least_rad = 10.0 * identification.roll_noise_rad.mean;
    let known = identification.half_cycles.iter().zip(frequency);
    let (lo, hi) = known
        .filter(|(at, _)| at.amplitude_rad >= least_rad)
        .fold((w.lo95, w.hi95), |(lo, hi), (_, &w)| (lo.min(w), hi.max(w)));
    let margin = 0.15 * (hi - lo);
    axis.limited(lo - margin, hi + margin)
}
