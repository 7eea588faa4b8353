//! Damping against roll rate with the fitted law (Fig. 12).

use maud::Markup;

use super::RunPage;
use crate::inverse::identification::CurvePoint;
use crate::report::document::section;
use crate::report::field_units::fitted_damping;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, Shape};

/// Points of the fitted law, an odd number so that zero is one of them.
const N_LAW: i32 = 81;

/// Times the usual standard deviation above which a sample of the moment is barely known.
const VAGUE: f64 = 1.5;

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let (moment, fit) = (&page.identification().moment, &page.identification().damping);
    let rate_max = moment.roll_rate_rad_per_s.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
    if rate_max <= 0.0 || moment.mean_per_s2.is_empty() {
        return None;
    }
    let damping: Vec<_> = moment.mean_per_s2.iter().map(|u| -u).collect();
    let half = N_LAW / 2;
    let rate: Vec<_> = (-half..=half).map(|k| rate_max * f64::from(k) / f64::from(half)).collect();
    let law: Vec<_> = rate.iter().map(|&rate| fitted_damping(fit, rate)).collect();
    let mut sds = moment.sd_per_s2.clone();
    sds.sort_by(f64::total_cmp);
    let usual = sds.get(sds.len() / 2).copied().unwrap_or(0.0);
    let vague = |k: usize| moment.sd_per_s2.get(k).is_some_and(|sd| *sd > VAGUE * usual);
    let panel = Panel::new(Axis::new("B/(I+ΔI) = −U [rad/s²]"))
        .height(300)
        .points(
            &part_of(&moment.roll_rate_rad_per_s, |k| !vague(k)),
            &part_of(&damping, |k| !vague(k)),
            Ink::new(Hue::Grey).shaped(Shape::Dot).named("posterior mean"),
        )
        .points(
            &part_of(&moment.roll_rate_rad_per_s, vague),
            &part_of(&damping, vague),
            Ink::new(Hue::Orange).shaped(Shape::Dot).named("the same, barely known"),
        )
        .band(
            &rate,
            &law.iter().map(|at| at.lo95).collect::<Vec<_>>(),
            &law.iter().map(|at| at.hi95).collect::<Vec<_>>(),
            Ink::new(Hue::Vermillion).named("95 % band of the law"),
        )
        .line(
            &rate,
            &law.iter().map(|at| at.mean).collect::<Vec<_>>(),
            Ink::new(Hue::Vermillion).wide(1.8).named("b₁ φ′ + b₃ φ′³"),
        );
    let panel = with_curve(page, panel);
    let figure =
        Figure::new("scatter", "Damping against roll rate", Axis::new("roll rate φ′ [rad/s]"))
            .caption(
                "A loop instead of a curve would mean a moment in phase with the roll angle. \
                 Orange: standard deviation above 1.5 times the median, as at the ends of a run.",
            )
            .panel(panel);
    Some(section("scatter-section", "Damping against roll rate", &figure.markup()))
}

/// Adds the damping curve of all forms of law together, where there is one.
fn with_curve(page: &RunPage, panel: Panel) -> Panel {
    let curve = &page.identification().damping_curve;
    if curve.is_empty() {
        return panel;
    }
    // The damping is odd in the rate: the other half mirrors this one.
    let mirrored = |of: &dyn Fn(&CurvePoint) -> (f64, f64)| -> Vec<f64> {
        let below = curve.iter().skip(1).rev().map(|point| -of(point).1);
        below.chain(curve.iter().map(|point| of(point).0)).collect()
    };
    let rate = mirrored(&|point| (point.rate_rad_per_s, point.rate_rad_per_s));
    let ends = |point: &CurvePoint| (point.damping_per_s2.lo95, point.damping_per_s2.hi95);
    let lo = mirrored(&|point| ends(point));
    let hi = mirrored(&|point| (ends(point).1, ends(point).0));
    let mean = mirrored(&|point| (point.damping_per_s2.mean, point.damping_per_s2.mean));
    panel.band(&rate, &lo, &hi, Ink::new(Hue::Green).named("95 % band whatever the form")).line(
        &rate,
        &mean,
        Ink::new(Hue::Green).named("all forms of law together"),
    )
}

fn part_of(values: &[f64], kept: impl Fn(usize) -> bool) -> Vec<f64> {
    let all = values.iter().enumerate();
    all.filter(|&(index, _)| kept(index)).map(|(_, &value)| value).collect()
}
