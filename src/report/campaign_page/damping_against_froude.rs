//! Linear damping against Froude number of all conditions, with the fitted laws (Fig. 14).

use maud::Markup;

use super::CampaignPage;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::FroudeLaw;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Ink, Panel, Shape};
use crate::run::RunKind;

/// Conditions in one panel; the bands of more would hide each other.
const N_IN_A_PANEL: usize = 3;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let figure = figure(page)?;
    Some(section("damping-against-froude", "Damping against Froude number", &figure.markup()))
}

/// The figure itself, which the report also leaves as a file of its own.
pub(super) fn figure(page: &CampaignPage) -> Option<Figure> {
    let conditions = page.conditions();
    if conditions.is_empty() {
        return None;
    }
    let height = if conditions.len() > N_IN_A_PANEL { 220 } else { 320 };
    let mut figure = Figure::new(
        "damping",
        "Linear damping against Froude number",
        Axis::new("Froude number Fr [–]"),
    );
    let mut forced_left_out = false;
    for (chunk, conditions) in conditions.chunks(N_IN_A_PANEL).enumerate() {
        let mut panel = Panel::new(Axis::new("b₁ [1/s]").holding(0.0)).height(height);
        for (index, condition) in conditions.iter().enumerate() {
            let ink = || Ink::of_series(chunk * N_IN_A_PANEL + index);
            let law = page.results.froude_laws.iter().find(|law| law.condition == *condition);
            if let Some(law) = law {
                panel = with_law(panel, law, ink);
            }
            let decays = bars(page, condition, RunKind::Decay);
            let forced = bars(page, condition, RunKind::Forced);
            // One forced run hardly parts b1 from b3; where there are decays they tell b1.
            forced_left_out |= !decays.is_empty() && !forced.is_empty();
            panel = if decays.is_empty() {
                let ink = ink().shaped(Shape::OpenCircle);
                panel.error_bars(&forced, ink.named(format!("{condition}, forced")))
            } else {
                panel.error_bars(&decays, ink().named(*condition))
            };
        }
        figure = figure.panel(panel);
    }
    Some(figure.caption(caption(page, forced_left_out)))
}

fn bars(page: &CampaignPage, condition: &str, kind: RunKind) -> Vec<(f64, f64, f64, f64)> {
    page.runs_of(condition)
        .filter(|run| run.run.kind == kind)
        .map(|run| (run.froude, run.identification.damping.b1_per_s))
        .map(|(froude, b1)| (froude, b1.mean, b1.lo95, b1.hi95))
        .collect()
}

fn with_law(panel: Panel, law: &FroudeLaw, ink: impl Fn() -> Ink) -> Panel {
    let ends = |end: fn(&Estimate) -> f64| -> Vec<f64> { law.b1_per_s.iter().map(end).collect() };
    let name = format!("{}, law", law.condition);
    panel
        .band(&law.froude, &ends(|at| at.lo95), &ends(|at| at.hi95), ink().named("95 % band"))
        .line(&law.froude, &ends(|at| at.mean), ink().wide(1.8).named(name))
}

fn caption(page: &CampaignPage, forced_left_out: bool) -> String {
    let mut caption =
        "Points: single free decays; bars: their 95 % intervals, often shorter than the mark \
                       is high."
            .to_owned();
    if !page.results.froude_laws.is_empty() {
        caption += " Lines: the law b₁(Fr) = b₀ (1 + κ Fr²); shaded: its 95 % band, \
                    as wide as the scatter of the runs about the law leaves it.";
    }
    if forced_left_out {
        caption += " Forced runs are not drawn, for one amplitude hardly parts b₁ from b₃; they \
                    stand in the figure of the equivalent damping by their b_{eq}.";
    }
    caption
}
