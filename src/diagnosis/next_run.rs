//! Which run would say most: by the expected Bayes factor where causes are undecided, else by what
//! the law of damping would gain.

use std::sync::Arc;

use super::alike::open_shapes;
use super::cores;
use super::elimination::Products;
use super::growth::{Grown, leftovers};
use super::observation::Observation;
use super::plan::{Plan, plans};
use super::run_fit::{RunState, predict, summarise};
use super::score::{Scored, score};
use super::settle::{Settled, settle};
use super::solve::{Joint, OneMore};
use super::survey::{Fit, N_LAW, Survey};
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

/// The fit with the set of each extension that a new run would have.
fn with_run(survey: &Survey, fit: &Fit, run: &Observation, state: RunState) -> Fit {
    let mut fit = fit.clone();
    for extension in &mut fit.extensions {
        let slot = match extension.effect.scope {
            crate::model::Scope::Campaign => Some(0),
            crate::model::Scope::Condition => Some(survey.condition_of[0]),
            crate::model::Scope::Run => None,
        };
        extension.slot_of.push(slot.filter(|_| (extension.effect.shows)(&run.at)));
    }
    fit.states.push(state);
    fit
}

fn grown_survey(survey: &Survey, run: Observation) -> Survey {
    let mut runs = survey.runs.clone();
    runs.push(Arc::new(run));
    let mut condition_of = survey.condition_of.clone();
    condition_of.push(survey.condition_of[0]);
    Survey { runs, conditions: survey.conditions.clone(), condition_of }
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

/// Times that a rival is linearised anew on a run that it has not seen.
const RELINEARISED: usize = 4;

/// A rival with all that the runs so far say of it.
struct Rival {
    settled: Settled,
    /// The runs so far under its scatter.
    products: Products,
    /// What they leave.
    least_misfit: f64,
}

impl Rival {
    fn new(survey: &Survey, settled: Settled) -> Self {
        let joint = Joint::new(survey, &settled.fit, &settled.summaries);
        let (_, products) = joint.gathered(&settled.solution.scatter);
        let least_misfit = settled.solution.least_misfit;
        Self { settled, products, least_misfit }
    }
}

/// Half of the misfit that a rival would keep on a run that the favourite made, or the logarithm
/// by which the run narrows the rival's shape.
fn expected(
    survey: &Survey,
    (favourite_id, favourite): (&str, &Fit),
    rival: &Rival,
    (plan, span_s): &(Plan, f64),
    left: [f64; 2],
) -> f64 {
    let (mut run, state, noise) = plan.observed(survey, favourite, *span_s, left);
    let truth = with_run(survey, favourite, &run, state.clone());
    let last = survey.runs.len();
    let readings = predict(&run, &state, &truth.terms(last));
    let n_roll = run.roll_time_s.len();
    (run.roll_rad, run.moment_n_m) = (readings[..n_roll].to_vec(), readings[n_roll..].to_vec());
    let known = &rival.settled.fit;
    let law = known.laws[survey.condition_of[0]].at(plan.froude);
    let mut guess = state;
    (guess.base.natural_rad_s, guess.base.b1_per_s, guess.base.b3_s) = (law[0], law[1], law[2]);
    guess.base.log_scale = known.log_scale;
    let mut fit = with_run(survey, known, &run, guess);
    let grown = grown_survey(survey, run);
    let scatter = rival.settled.solution.scatter;
    let mut left_over = f64::INFINITY;
    let mut narrowed = None;
    // The rival may answer with all its numbers, as far as the runs so far let it.
    let mut terms = fit.terms(last);
    for _ in 0..RELINEARISED {
        let mut summary = summarise(&grown.runs[last], &fit.states[last], &terms, &[], &noise);
        let moved_by: Vec<f64> = terms
            .iter()
            .zip(fit.terms(last))
            .flat_map(|(now, then)| {
                now.values.iter().zip(then.values).map(|(n, t)| n - t).collect::<Vec<_>>()
            })
            .collect();
        summary.refer_back(&moved_by);
        let solved = OneMore::new(&rival.products, &grown, &fit, &summary, &scatter);
        left_over = solved.least_misfit();
        narrowed = open_shapes(survey, known, favourite_id).map(|(_, shapes)| {
            let covariance = solved.eliminated.covariance();
            let before = &rival.settled.solution.covariance;
            let gains =
                shapes.iter().map(|(_, c)| 0.5 * (before[*c][*c] / covariance[*c][*c]).ln());
            gains.fold(f64::INFINITY, f64::min)
        });
        (terms, fit.states[last]) = solved.moved(&grown, &fit, &summary);
    }
    // Where the rival is the favourite with its shape left open, nothing but that shape parts them.
    narrowed.unwrap_or_else(|| 0.5 * (left_over - rival.least_misfit).max(0.0))
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
    let scored = score(survey, &without, &grown.noise);
    let scored: Vec<&Scored> = rivals
        .iter()
        .filter_map(|id| scored.iter().find(|s| s.extension.effect.id == *id))
        .collect();
    let settled = cores::each(scored.len(), |k| {
        let mut fit = without.clone();
        fit.extensions.push(scored[k].extension.clone());
        Rival::new(survey, settle(survey, fit, &grown.noise))
    });
    let left = left_in_channels(survey, &grown.last.fit);
    let only_forced = rivals.iter().any(|rival| is_one_in_decays(favourite, rival));
    let mut plans = plans(tank, survey);
    plans.retain(|(plan, _)| !only_forced || plan.kind == RunKind::Forced);
    // The rival that is hardest to part decides.
    let hardest = cores::each(plans.len(), |k| {
        settled
            .iter()
            .map(|rival| expected(survey, (favourite, &grown.last.fit), rival, &plans[k], left))
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
    let is_shape = settled.iter().any(is_open);
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
        let solved = OneMore::new(&known, &grown_survey(survey, run), &fit, &summary, &scatter);
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
