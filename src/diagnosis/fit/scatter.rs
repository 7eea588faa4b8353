//! How far the runs of a condition lie from their law, and how far they may.

use super::survey::{Fit, Survey};

/// How far runs of one condition lie from their law, as shares of its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::diagnosis) struct Scatter {
    pub(in crate::diagnosis) damping: f64,
    pub(in crate::diagnosis) frequency: f64,
}

/// Scatters that are weighed: from none to that of the seed paper's Table 2 and beyond.
const DAMPING: [f64; 8] = [1e-3, 0.006, 0.012, 0.02, 0.035, 0.06, 0.15, 0.35];
const FREQUENCY: [f64; 4] = [1e-5, 5e-4, 2e-3, 1e-2];

/// Every scatter that is weighed; a campaign whose conditions have one run each has none.
pub(in crate::diagnosis) fn scatters(survey: &Survey) -> Vec<Scatter> {
    let repeats = (0..survey.conditions.len()).any(|c| survey.members(c).len() > 1);
    if !repeats {
        return vec![Scatter { damping: DAMPING[0], frequency: FREQUENCY[0] }];
    }
    all_scatters().collect()
}

/// Every scatter that is weighed where runs repeat.
pub(in crate::diagnosis) fn all_scatters() -> impl Iterator<Item = Scatter> {
    let pairs = DAMPING.iter().flat_map(|d| FREQUENCY.iter().map(move |f| (*d, *f)));
    pairs.map(|(damping, frequency)| Scatter { damping, frequency })
}

/// Deviation of a run from its law: frequency, linear and cubic damping.
pub(super) fn deviation(survey: &Survey, fit: &Fit, run: usize) -> [f64; 3] {
    let expected = fit.laws[survey.condition_of[run]].at(survey.runs[run].at.froude);
    let base = &fit.states[run].base;
    [base.natural_rad_s - expected[0], base.b1_per_s - expected[1], base.b3_s - expected[2]]
}

/// Standard deviations of a run about its law.
pub(super) fn spread(survey: &Survey, fit: &Fit, run: usize, scatter: &Scatter) -> [f64; 3] {
    let [w, b1, b3] = fit.laws[survey.condition_of[run]].at(survey.runs[run].at.froude);
    // A law that has lost its sign still scatters by a share of a usual damping.
    let size = survey.runs[run].at.b1_per_s;
    let amplitude = survey.runs[run].at.amplitude_rad.max(0.02);
    let b3_size =
        b3.abs().max(0.1 * size / (w * amplitude).powi(2)).min(size / (w * amplitude).powi(2));
    [scatter.frequency * w, scatter.damping * b1.abs().max(0.3 * size), scatter.damping * b3_size]
}
