//! How good an answer is: named, in the class, a wrong name, or an honest abstention.

use super::plan::RunSet;
use super::verdict::{Cause, Verdict};

/// Classes of EFFECTS.md section 6: on these run sets no run parts the members.
const CLASSES: [(&[&str], &[RunSet]); 8] = [
    (&["restoring.heel", "instrument.roll_offset"], &ANY),
    (&["damping.quadratic", "damping.power_law"], &ANY),
    (&["restoring.cubic", "inertia.amplitude"], &DECAYS),
    (&["restoring.speed", "inertia.speed"], &DECAYS),
    (&["tank.slow_release", "instrument.roll_lag"], &DECAYS),
    (&["tank.unsteady_speed", "damping.start_up"], &DECAYS),
    (&["instrument.roll_lag", "instrument.channel_skew"], &[RunSet::Forced]),
    (&UNTESTABLE, &ANY),
];
const ANY: [RunSet; 3] = [RunSet::Rest, RunSet::Speeds, RunSet::Forced];
const DECAYS: [RunSet; 2] = [RunSet::Rest, RunSet::Speeds];

/// Effects that only a static run can show: naming none of them is the right answer.
pub(crate) const UNTESTABLE: [&str; 4] = [
    "restoring.cable",
    "restoring.natural_frequency",
    "instrument.roll_gain",
    "instrument.force_gain",
];

/// What an effect brings along in a run that starts later than it: a zero that drifts from the
/// start of the recording has moved by the release. Naming this as well is no wrong name.
const COMPANIONS: [(&str, &str); 3] = [
    ("instrument.roll_drift", "instrument.roll_offset"),
    ("instrument.roll_drift", "restoring.heel"),
    ("instrument.force_drift", "instrument.force_offset"),
];

/// What an answer is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Every hidden effect by its own name, and nothing else.
    Named,
    /// Every hidden effect by its name or class, and nothing else.
    InClass,
    /// Some of the hidden effects, and nothing else.
    Partly,
    /// All hidden effects, and a name that is not there.
    WithMore,
    /// A name that is not there.
    WrongName,
    /// Nothing named: nothing wrong.
    Adequate,
    /// Nothing named: something is, but unknown.
    Unexplained,
}

/// Whether two effects are one class on a run set.
pub(crate) fn in_class(one: &str, other: &str, set: RunSet) -> bool {
    one == other
        || CLASSES.iter().any(|(names, sets)| {
            sets.contains(&set) && names.contains(&one) && names.contains(&other)
        })
}

/// Whether one of two effects brings the other along, so that both are one.
pub(crate) fn are_companions(one: &str, other: &str) -> bool {
    COMPANIONS.iter().any(|pair| *pair == (one, other) || *pair == (other, one))
}

/// Scores a verdict against what hides; `stands_for(cause, hidden)` is asked last, whether on
/// these very runs the cause reproduces the hidden effect within the noise.
pub(crate) fn score(
    verdict: &Verdict,
    hidden: &[String],
    set: RunSet,
    mut stands_for: impl FnMut(&str, &str) -> bool,
) -> Outcome {
    if verdict.causes.is_empty() {
        return match verdict.word.as_str() {
            "adequate" => Outcome::Adequate,
            _ => Outcome::Unexplained,
        };
    }
    let names_it = |cause: &Cause, truth: &String| cause.effect == *truth;
    let by_name = verdict.word == "named"
        && hidden.iter().all(|truth| verdict.causes.iter().any(|cause| names_it(cause, truth)))
        && verdict.causes.iter().all(|cause| hidden.contains(&cause.effect));
    if by_name {
        return Outcome::Named;
    }
    let mut found = vec![false; hidden.len()];
    let mut astray = false;
    for cause in &verdict.causes {
        let exact = hidden.iter().position(|truth| names_it(cause, truth));
        let comes_along = COMPANIONS.iter().any(|(truth, beside)| {
            let names = |id: &str| verdict.causes.iter().any(|cause| cause.effect == id);
            cause.effect == *beside && hidden.iter().any(|id| id == truth) && names(truth)
        });
        if exact.is_none() && comes_along {
            continue;
        }
        let told = || {
            hidden.iter().position(|truth| {
                in_class(&cause.effect, truth, set) || cause.equivalent_to.contains(truth)
            })
        };
        let shown = exact
            .or_else(told)
            .or_else(|| hidden.iter().position(|truth| stands_for(&cause.effect, truth)));
        match shown {
            Some(at) => found[at] = true,
            None => astray = true,
        }
    }
    match (found.iter().all(|found| *found) && !hidden.is_empty(), astray) {
        (true, false) => Outcome::InClass,
        (true, true) => Outcome::WithMore,
        (false, true) => Outcome::WrongName,
        (false, false) => Outcome::Partly,
    }
}
