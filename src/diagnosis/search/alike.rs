//! Which effects these runs cannot tell apart.

use super::entered::ENTERS;
use crate::diagnosis::fit::layout::Layout;
use crate::diagnosis::fit::scatter::scatters;
use crate::diagnosis::fit::settle::Settled;
use crate::diagnosis::fit::solve::solve;
use crate::diagnosis::fit::survey::{Extension, Fit, Survey};
use crate::model::effects;
use crate::model::{Acts, Layer};

/// Difference of misfits below which two effects cannot be told apart.
pub(in crate::diagnosis) const SAME: f64 = 12.0;
/// The share below which two effects are alike where as much again is left unexplained: a residual
/// wave fitted beside amplitude-dependent inertia in the measured decay of KVLCC2 sets cubic
/// restoring, its equal in any decay, back by 6.5 %.
const ALIKE_SHARE: f64 = 0.1;

/// A form that another takes at one value of its shape: it is no other cause where the runs say
/// that the shape is within so much of it. A quarter of a power was set by trial on simulated
/// campaigns, whose power laws of 1.3 to 1.8 kept their name.
const FORMS: [Form; 1] = [Form {
    wide: "damping.power_law",
    shape: "p",
    at: 2.0,
    within: 0.25,
    narrow: "damping.quadratic",
}];

/// A form of an effect that is another effect.
pub(in crate::diagnosis) struct Form {
    wide: &'static str,
    shape: &'static str,
    at: f64,
    within: f64,
    narrow: &'static str,
}

/// Whether the effect at a place of a model is another, `narrow`, its shape left open, and these
/// runs say that it has the shape of that.
pub(super) fn is_form_of(survey: &Survey, wide: &Settled, place: usize, narrow: &str) -> bool {
    let Some((form, shapes)) = shapes(survey, &wide.fit, place, narrow) else { return false };
    shapes.into_iter().all(|(value, column)| {
        let sd = wide.solution.covariance[column][column].max(0.0).sqrt();
        (value - form.at).abs() + 2.0 * sd < form.within
    })
}

/// The same of the newest effect of a model.
pub(super) fn is_newest_form_of(survey: &Survey, wide: &Settled, narrow: &str) -> bool {
    let places = wide.fit.extensions.len();
    places.checked_sub(1).is_some_and(|newest| is_form_of(survey, wide, newest, narrow))
}

/// The shapes that the newest effect of a fit leaves open beside a narrower form of it: value and
/// column of each set; none where it is no wider form.
pub(in crate::diagnosis) fn open_shapes(
    survey: &Survey,
    fit: &Fit,
    narrow: &str,
) -> Option<(&'static Form, Vec<(f64, usize)>)> {
    shapes(survey, fit, fit.extensions.len().checked_sub(1)?, narrow)
}

/// Logarithm by which runs must narrow the shapes of the newest effect, that they may say whether
/// it is a narrower form: to a quarter of what that allows, so that a shape may lie half of it off.
/// None where it is no wider form.
pub(in crate::diagnosis) fn narrowing_wanted(
    survey: &Survey,
    wide: &Settled,
    narrow: &str,
) -> Option<f64> {
    let (form, shapes) = open_shapes(survey, &wide.fit, narrow)?;
    let wanted = shapes.into_iter().map(|(_, column)| {
        let sd = wide.solution.covariance[column][column].max(0.0).sqrt();
        (4.0 * sd / form.within).ln()
    });
    Some(wanted.fold(0.0, f64::max))
}

/// The shapes that the effect at a place leaves open beside a narrower form of it.
fn shapes(
    survey: &Survey,
    fit: &Fit,
    place: usize,
    narrow: &str,
) -> Option<(&'static Form, Vec<(f64, usize)>)> {
    let Extension { effect, slots, .. } = fit.extensions.get(place)?;
    let form = FORMS.iter().find(|form| form.wide == effect.id && form.narrow == narrow)?;
    let k = (0..effect.n_parameters()).find(|k| effect.parameter(*k).symbol == form.shape)?;
    let layout = Layout::new(survey, fit);
    let shapes = slots.iter().enumerate();
    Some((form, shapes.map(|(s, all)| (all[k], layout.parameter(fit, place, s, k))).collect()))
}

/// Whether these runs cannot tell a rival from the favourite: it is as probable, or falls a little
/// behind, by less than what the favourite itself leaves: `left`, in units of the noise's variance.
pub(super) fn is_same(
    survey: &Survey,
    before: &Settled,
    favourite: &Settled,
    rival: &Settled,
    left: f64,
) -> bool {
    let narrow = favourite.fit.extensions.last();
    if narrow.is_some_and(|narrow| is_newest_form_of(survey, rival, narrow.effect.id)) {
        return false;
    }
    let behind = favourite.log_evidence - rival.log_evidence;
    let gained = rival.log_evidence - before.log_evidence;
    let (most, as_well) = (explained(survey, before, favourite), explained(survey, before, rival));
    let room = SAME.max(left.min(ALIKE_SHARE * most));
    // What is far less probable is no equal, whatever scatter lets it explain.
    let is_near = behind < SAME.max(left.min(ALIKE_SHARE * (gained + behind)));
    let explains_it = gained > ENTERS && most - as_well < room && is_near;
    let is_as_probable = 2.0 * behind < SAME && gained > 0.5 * ENTERS;
    is_as_probable || (explains_it && !is_of_most_runs(survey, rival))
}

/// Whether a rival has numbers of its own for most runs: with these it comes near to any effect,
/// and only what they cost in evidence tells it from that.
fn is_of_most_runs(survey: &Survey, rival: &Settled) -> bool {
    rival.fit.extensions.last().is_some_and(|newest| {
        newest.effect.scope.is_of_each_run() && 2 * newest.slots.len() > survey.runs.len()
    })
}

/// Whether a rival holds the favourite as a part, as a drift holds the zero that it starts from:
/// it explains as much and is no other cause.
pub(super) fn contains(rival: &str, favourite: &str) -> bool {
    let (Some(rival), Some(favourite)) = (effects::effect(rival), effects::effect(favourite))
    else {
        return false;
    };
    rival.strengths.len() > favourite.strengths.len()
        && favourite.strengths.iter().all(|part| {
            rival.strengths.iter().any(|p| p.symbol == part.symbol && p.unit == part.unit)
        })
}

/// Whether the form of an effect stands for many that differ a little: waves, memories, hands, a
/// ringing.
pub(in crate::diagnosis) fn is_approximate(id: &str) -> bool {
    effects::effect(id).is_some_and(|effect| {
        let remembers = matches!(effect.acts, Acts::Lagging(_));
        effect.layer == Layer::Tank || remembers || effect.is_ringing()
    })
}

/// The fall of the misfit from one model to the next when no run may leave its law: what scatter
/// could hide is still explained.
fn explained(survey: &Survey, before: &Settled, after: &Settled) -> f64 {
    let tight = scatters(survey)[0];
    let least =
        |settled: &Settled| solve(survey, &settled.fit, &settled.summaries, tight).least_misfit;
    least(before) - least(after)
}
