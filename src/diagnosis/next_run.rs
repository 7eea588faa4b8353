//! Which run would say most: by the expected Bayes factor where causes are undecided, else by what
//! the law of damping would gain.

use super::added::Added;
use super::alike::open_shapes;
use super::cores;
use super::foretold::{Rival, expected_log_bayes_factor, grown_survey, with_run};
use super::growth::{Grown, leftovers};
use super::plan::{Plan, plans};
use super::run_fit::summarise;
use super::score::score;
use super::settle::settle;
use super::solve::Joint;
use super::survey::{Fit, N_LAW, Survey};
use super::trial::fit_all;
use crate::campaign::Tank;
use crate::run::RunKind;

/// A run worth towing.
#[derive(Debug, Clone, PartialEq)]
pub struct NextRun {
    /// `decay`, `forced` or `rest_reading`.
    pub kind: &'static str,
    /// Froude number [-].
    pub froude: f64,
    /// Frequency of the excitation [rad/s] of a forced run.
    pub frequency_rad_s: Option<f64>,
    /// Roll amplitude [deg].
    pub amplitude_deg: f64,
    /// The effects that it parts.
    pub parts: Vec<&'static str>,
    /// Expected logarithm of the Bayes factor between them, or of the law's volume.
    pub expected_log_bayes_factor: f64,
    /// Why, in words.
    pub why: String,
}

/// Pairs that are one in a roll near its natural frequency `w`, whatever the amplitude, because
/// `phi^2 phi'' = -w^2 phi^3` and `K/I = w^2` there: what parts them in a decay is what neither
/// explains.
const ONE_IN_DECAYS: [[&str; 2]; 2] =
    [["restoring.cubic", "inertia.amplitude"], ["restoring.speed", "inertia.speed"]];

fn is_one_in_decays(a: &str, b: &str) -> bool {
    ONE_IN_DECAYS.iter().any(|pair| *pair == [a, b] || *pair == [b, a])
}

/// Root mean square of what a model leaves of roll [rad] and moment [N m] in a middling run: to
/// the next run that is noise too.
fn left_in_channels(survey: &Survey, fit: &Fit) -> [f64; 2] {
    let all = leftovers(survey, fit);
    ["roll", "moment"].map(|channel| {
        let of_channel = all.iter().filter(|left| left.channel == channel);
        let mut rms: Vec<f64> = of_channel.map(|left| left.rms).collect();
        rms.sort_by(f64::total_cmp);
        rms.get(rms.len() / 2).copied().unwrap_or(0.0)
    })
}

/// The run that says most.
pub(super) fn next_run(survey: &Survey, grown: &Grown, tank: &Tank) -> Option<NextRun> {
    let undecided = grown.entered.iter().enumerate().find(|(_, e)| !e.equivalent_to.is_empty());
    if let Some((place, entered)) = undecided {
        return parting(survey, grown, tank, place, entered.id, &entered.equivalent_to);
    }
    let always = grown
        .last
        .fit
        .extensions
        .iter()
        .find(|extension| !extension.effect.always_equivalent.is_empty());
    if let Some(extension) = always {
        let mut parts = vec![extension.effect.id];
        parts.extend(extension.effect.always_equivalent);
        return Some(NextRun {
            kind: "rest_reading",
            froude: 0.0,
            frequency_rad_s: None,
            amplitude_deg: 0.0,
            parts,
            expected_log_bayes_factor: 0.0,
            why: "no roll test parts a heel of the model from a zero of its channel; an \
                  inclinometer read with the model at rest does"
                .to_owned(),
        });
    }
    informing(survey, grown, tank)
}

fn parting(
    survey: &Survey,
    grown: &Grown,
    tank: &Tank,
    place: usize,
    favourite: &'static str,
    rivals: &[&'static str],
) -> Option<NextRun> {
    let mut without = grown.last.fit.clone();
    without.extensions.remove(place);
    let without = settle(survey, without, &grown.noise);
    let mut scored = score(survey, &without.fit, &grown.noise);
    scored.retain(|s| rivals.contains(&s.extension.effect.id));
    let tried = fit_all(survey, &without, &scored, &grown.noise);
    let rivals_so_far: Vec<Rival> =
        tried.into_iter().map(|one| Rival::new(survey, one.settled)).collect();
    let left = left_in_channels(survey, &grown.last.fit);
    let only_forced = rivals.iter().any(|rival| is_one_in_decays(favourite, rival));
    let mut plans = plans(tank, survey);
    plans.retain(|(plan, _)| !only_forced || plan.kind == RunKind::Forced);
    // The rival that is hardest to part decides.
    let hardest = cores::each(plans.len(), |k| {
        rivals_so_far
            .iter()
            .map(|rival| {
                let planned = std::slice::from_ref(&plans[k]);
                let favourite = (favourite, &grown.last.fit);
                expected_log_bayes_factor(survey, favourite, rival, planned, left)
            })
            .fold(f64::INFINITY, f64::min)
    });
    let mut best: Option<(f64, Plan)> = None;
    for (least, planned) in hardest.into_iter().zip(plans) {
        if least.is_finite() && best.is_none_or(|(most, _)| least > 1.05 * most) {
            best = Some((least, planned.0));
        }
    }
    let (log, plan) = best?;
    let mut parts = vec![favourite];
    parts.extend(rivals);
    let w = grown.last.fit.laws[survey.condition_of[0]].numbers[0];
    let is_open = |rival: &Rival| open_shapes(survey, &rival.settled.fit, favourite).is_some();
    let is_shape = rivals_so_far.iter().any(is_open);
    let log = if is_shape { 0.0 } else { log };
    Some(told(&plan, w, parts, log, |what| {
        let rivals = rivals.join(", ");
        if is_shape {
            return format!(
                "{what} tells the shape of {rivals} best, and whether it is {favourite}"
            );
        }
        format!(
            "{what} parts {favourite} from {rivals} by an expected log Bayes factor of {log:.0}"
        )
    }))
}

fn told(
    plan: &Plan,
    natural_rad_s: f64,
    parts: Vec<&'static str>,
    log: f64,
    why: impl Fn(&str) -> String,
) -> NextRun {
    let frequency_rad_s = (plan.kind == RunKind::Forced).then_some(plan.tuning * natural_rad_s);
    let what = match frequency_rad_s {
        Some(w) => format!(
            "a forced run of {:.0} deg at {w:.2} rad/s ({}) and Fr {:.2}",
            plan.amplitude_deg,
            if (plan.tuning - 1.0).abs() < 0.01 { "at resonance" } else { "off resonance" },
            plan.froude
        ),
        None => format!("a decay from {:.0} deg at Fr {:.2}", plan.amplitude_deg, plan.froude),
    };
    NextRun {
        kind: if plan.kind == RunKind::Forced { "forced" } else { "decay" },
        froude: plan.froude,
        frequency_rad_s,
        amplitude_deg: plan.amplitude_deg,
        parts,
        expected_log_bayes_factor: log,
        why: why(&what),
    }
}

/// The decay that narrows the law of damping most.
fn informing(survey: &Survey, grown: &Grown, tank: &Tank) -> Option<NextRun> {
    let last = &grown.last;
    let scatter = last.solution.scatter;
    let law = N_LAW * survey.condition_of[0];
    let volume = |covariance: &[Vec<f64>]| {
        let (a, b, c) = (
            covariance[law + 1][law + 1],
            covariance[law + 2][law + 2],
            covariance[law + 1][law + 2],
        );
        0.5 * (a * b - c * c).max(1e-300).ln()
    };
    let now = volume(&last.solution.covariance);
    let (_, known) = Joint::new(survey, &last.fit, &last.summaries).gathered(&scatter);
    let left = left_in_channels(survey, &last.fit);
    let mut plans = plans(tank, survey);
    plans.retain(|(plan, _)| plan.kind == RunKind::Decay && plan.amplitude_deg > 0.0);
    let gains = cores::each(plans.len(), |k| {
        let (plan, span_s) = &plans[k];
        let (mut run, state, noise) = plan.observed(survey, &last.fit, *span_s, left);
        let fit = with_run(survey, &last.fit, &run, state.clone());
        let terms = fit.terms(survey.runs.len());
        // What it reads does not matter to what it would tell.
        run.roll_rad = vec![0.0; run.roll_time_s.len()];
        run.moment_n_m = Vec::new();
        let summary = summarise(&run, &state, &terms, &[], &noise);
        let grown = grown_survey(survey, vec![run]);
        let solved = Added::new((&last.fit, &known), &grown, &fit, &[summary], &scatter);
        now - volume(&solved.eliminated.covariance())
    });
    let mut best: Option<(f64, Plan)> = None;
    for (gain, planned) in gains.into_iter().zip(plans) {
        if best.is_none_or(|(most, _)| gain > 1.05 * most) {
            best = Some((gain, planned.0));
        }
    }
    let (log, plan) = best?;
    let w = last.fit.laws[survey.condition_of[0]].numbers[0];
    Some(told(&plan, w, Vec::new(), log, |what| {
        format!("no cause is undecided; {what} narrows b0 and kappa most")
    }))
}
