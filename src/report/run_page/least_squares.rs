//! The least-squares solution beside the posterior mean (Fig. 9).

use maud::Markup;

use super::RunPage;
use crate::report::document::section;
use crate::report::figure::{Axis, Figure, Hue, Ink, Panel};

pub(super) fn part(page: &RunPage) -> Option<Markup> {
    let identification = page.identification();
    let (moment, least_squares) = (&identification.moment, &identification.least_squares_per_s2);
    if least_squares.is_empty() {
        return None;
    }
    let reach = reach(least_squares, &moment.mean_per_s2);
    let figure =
        Figure::new("least-squares", "Moment by least squares, for comparison", Axis::time())
            .caption(
                "Solved without a prior, (2.5) amplifies the noise of the roll; the posterior mean \
                 is drawn to the same scale, whose edge holds the farthest 0.5 %.",
            )
            .panel(
                Panel::new(Axis::new("U [rad/s²]").limited(-reach, reach))
                    .line(
                        &moment.time_s,
                        least_squares,
                        Ink::new(Hue::Grey).wide(0.8).named("least squares"),
                    )
                    .line(
                        &moment.time_s,
                        &moment.mean_per_s2,
                        Ink::new(Hue::Blue).wide(1.8).named("posterior mean"),
                    ),
            );
    Some(section("least-squares-section", "Least-squares solution", &figure.markup()))
}

/// Largest value drawn [rad/s2]: a few samples at a release would flatten all others.
fn reach(least_squares: &[f64], mean: &[f64]) -> f64 {
    let mut sizes: Vec<_> =
        least_squares.iter().map(|u| u.abs()).filter(|u| u.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let usual = sizes.get(sizes.len() * 995 / 1000).copied().unwrap_or(0.0);
    1.1 * mean.iter().map(|u| u.abs()).fold(usual, f64::max)
}
