//! Equivalent damping against Froude number, all conditions together.

use maud::Markup;

use super::CampaignPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Ink, Panel, Shape};
use crate::run::RunKind;

pub(super) fn part(page: &CampaignPage) -> Option<Markup> {
    let mut panel = Panel::new(Axis::new("b_{eq} [1/s]").holding(0.0)).height(280);
    let (mut any, mut any_forced) = (false, false);
    for (index, condition) in page.conditions().into_iter().enumerate() {
        let mut decays = Vec::new();
        let mut forced = Vec::new();
        for run in page.runs_of(condition) {
            let units = page.field_units(run);
            let (bars, damping) = match run.run.kind {
                RunKind::Decay => (&mut decays, units.at_comparison().map(|at| at.fitted_per_s)),
                RunKind::Forced => (&mut forced, units.work_damping_per_s()),
            };
            bars.extend(damping.map(|at| (run.froude, at.mean, at.lo95, at.hi95)));
        }
        let ink = || Ink::of_series(index);
        if !forced.is_empty() {
            (any, any_forced) = (true, true);
            let name = format!("{condition}, forced");
            let ink = ink().shaped(Shape::OpenCircle);
            panel = panel.error_bars(&forced, ink.named(name));
        }
        if !decays.is_empty() {
            any = true;
            panel = panel.error_bars(&decays, ink().named(condition));
        }
    }
    any.then(|| {
        let figure = Figure::new(
            "equivalent-damping",
            "Equivalent damping against Froude number",
            Axis::new("Froude number Fr [–]"),
        )
        .caption(caption(any_forced))
        .panel(panel);
        section("equivalent-damping-section", "Equivalent damping", &figure.markup())
    })
}

fn caption(any_forced: bool) -> String {
    let mut caption = "The value to compare between runs, since b₁ and b₃ trade against each \
                       other: free decays at 5 deg, from the law."
        .to_owned();
    if any_forced {
        caption += " Forced runs (open circles) at their own amplitude A₁, from the work per \
                    cycle, without a law; those at one speed differ in frequency, and with \
                    b₃ > 0 the damping grows with it.";
    }
    caption
}
