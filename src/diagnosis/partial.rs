//! Effects that take a part of what was left when they entered, and leave most of it.

use super::growth::{Grown, leftovers, sure_share};
use super::leftover::Leftover;
use super::settle::settle;
use super::survey::Survey;

/// Share of what was left before beyond which causes are no whole story; by trial on simulated
/// campaigns, of whose catalogued effects it takes only free surfaces from their names.
pub(super) const MOST_LEFT: f64 = 0.1;

/// Takes the last effects out of the model again that leave too much of what they found, the
/// first excepted; tells them. `counts` says whether a leftover is not told otherwise.
pub(super) fn take_out_parts(
    survey: &Survey,
    grown: &mut Grown,
    counts: &dyn Fn(&Leftover) -> bool,
) -> Vec<&'static str> {
    let mut parts = Vec::new();
    let mut left: Vec<Leftover> = leftovers(survey, &grown.last.fit);
    left.retain(counts);
    let is_left = left.iter().any(Leftover::is_sure);
    while let [_, .., last] = &grown.entered[..]
        && is_left
        && sure_share(&left) > MOST_LEFT * last.found
    {
        parts.push(last.id);
        grown.entered.pop();
        let mut fit = grown.last.fit.clone();
        fit.extensions.pop();
        grown.last = settle(survey, fit, &grown.noise).over_scatters(survey);
    }
    parts
}
