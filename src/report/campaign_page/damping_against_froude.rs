//! Linear damping against Froude number per condition, with the fitted law (Fig. 14).

use maud::{Markup, html};

use super::CampaignPage;
use crate::inverse::identification::FroudeLaw;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel, Shape};
use crate::report::number::mean;
use crate::run::RunKind;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let conditions = page.conditions();
    if conditions.is_empty() {
        return None;
    }
    Some(section(
        "damping-against-froude",
        "Damping against Froude number",
        &html! {
            @for (index, condition) in conditions.iter().enumerate() {
                (figure(page, index, condition).markup())
            }
        },
    ))
}

fn figure(page: &CampaignPage, index: usize, condition: &str) -> Figure {
    let law = page.results.froude_laws.iter().find(|law| law.condition == condition);
    let mut panel = Panel::new(Axis::new("b₁ [1/s]").holding(0.0)).height(260);
    let mut caption = "Bars are 95 % intervals of single runs.".to_owned();
    if let Some(law) = law {
        panel = with_law(panel, law);
        caption = format!(
            "b₁(Fr) = b₀ (1 + κ Fr²) with b₀ = {} 1/s, κ = {}; bars are 95 % intervals of single \
             runs, and what they leave open is the run-to-run scatter s_{{run}} = {} 1/s.",
            mean(&law.b0_per_s),
            mean(&law.kappa),
            mean(&law.scatter_per_s)
        );
    }
    for (kind, name, ink) in [
        (RunKind::Forced, "forced runs", Ink::new(Hue::Green).shaped(Shape::OpenCircle)),
        (RunKind::Decay, "free decays", Ink::new(Hue::Blue).shaped(Shape::Circle)),
    ] {
        let bars: Vec<_> = page
            .runs_of(condition)
            .filter(|run| run.run.kind == kind)
            .map(|run| (run.froude, run.identification.damping.b1_per_s))
            .map(|(froude, b1)| (froude, b1.mean, b1.lo95, b1.hi95))
            .collect();
        if !bars.is_empty() {
            panel = panel.error_bars(&bars, ink.named(name));
        }
    }
    Figure::new(
        format!("damping-{}", index + 1),
        format!("Linear damping against Froude number: {condition}"),
        Axis::new("Froude number Fr [–]"),
    )
    .caption(caption)
    .panel(panel)
}

fn with_law(panel: Panel, law: &FroudeLaw) -> Panel {
    let end = |end: fn(&crate::inverse::estimate::Estimate) -> f64| -> Vec<f64> {
        law.b1_per_s.iter().map(end).collect()
    };
    let ink = || Ink::new(Hue::Vermillion);
    panel.band(&law.froude, &end(|at| at.lo95), &end(|at| at.hi95), ink().named("95 % band")).line(
        &law.froude,
        &end(|at| at.mean),
        ink().wide(1.8).named("b₀ (1 + κ Fr²)"),
    )
}
