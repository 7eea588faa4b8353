//! Which run would say most: by the expected Bayes factor where causes are undecided, else by what
//! the law of damping would gain.

use std::sync::Arc;

use super::couples::{best_couple, most};
use super::foretold::{
    Foretold, RELINEARISED, foretold, foretold_together, grown_survey, with_run,
};
use super::known::Known;
use super::plan::{Plan, PlannedRun, SAMPLE_S, plans};
use crate::campaign::Tank;
use crate::diagnosis::fit::added::Added;
use crate::diagnosis::fit::cores;
use crate::diagnosis::fit::run_fit::{ChannelNoise, summarise};
use crate::diagnosis::fit::settle::settle;
use crate::diagnosis::fit::solve::Joint;
use crate::diagnosis::fit::survey::{N_LAW, Survey};
use crate::diagnosis::record::observation::Observation;
use crate::diagnosis::search::alike::{narrowing_wanted, open_shapes};
use crate::diagnosis::search::growth::Grown;
use crate::diagnosis::search::score::score;
use crate::diagnosis::search::trial::fit_all;
use crate::run::RunKind;

/// A run worth towing.
#[derive(Debug, Clone, PartialEq)]
pub struct NextRun {
    /// The run.
    pub run: PlannedRun,
    /// Another to tow with it, where one run alone is not expected to decide.
    pub with: Option<PlannedRun>,
    /// The effects that it parts.
    pub parts: Vec<&'static str>,
    /// Expected logarithm of the Bayes factor between them, or of the law's volume.
    pub expected_log_bayes_factor: f64,
    /// Whether the runs are expected to decide what is undecided.
    pub decides: bool,
    /// Why, in words.
    pub why: String,
}

/// Pairs that are one in a roll near its natural frequency `w`, whatever the amplitude, because
/// `phi^2 phi'' = -w^2 phi^3` and `K/I = w^2` there: what parts them in a decay is what neither
/// explains.
const ONE_IN_DECAYS: [[&str; 2]; 2] =
    [["restoring.cubic", "inertia.amplitude"], ["restoring.speed", "inertia.speed"]];

fn is_one_in_decays(a: &str, b: &str) -> bool {
    ONE_IN_DECAYS.iter().any(|pair| is_pair(*pair, a, b))
}

fn is_pair(pair: [&str; 2], a: &str, b: &str) -> bool {
    pair == [a, b] || pair == [b, a]
}

/// What parts causes that no roll of the model does (EFFECTS.md, section 6).
const BESIDE_THE_TANK: [([&str; 2], &str); 1] = [(
    ["instrument.channel_skew", "instrument.roll_lag"],
    "a tap on the model that both channels record",
)];

/// The noise of roll [rad] and moment [N m] in the middling run, with all that the model leaves of
/// it and its memory: to the next run that is noise too. None of a moment that no run reads.
fn noise_to_come(survey: &Survey, noise: &[ChannelNoise]) -> [Option<(f64, f64)>; 2] {
    let middling = |channel: usize, reads: fn(&Observation) -> bool| {
        let each = survey.runs.iter().zip(noise).filter(|(run, _)| reads(run));
        // A memory from one sample to the next is a shorter one where these lie further apart.
        let of_run = |(run, noise): (&Arc<Observation>, &ChannelNoise)| {
            let n_samples = [&run.roll_time_s, &run.moment_time_s][channel].len();
            let interval_s = run.at.span_s / (n_samples as f64 - 1.0).max(1.0);
            let samples = SAMPLE_S / interval_s.max(1e-6);
            (noise.sd[channel], noise.correlation[channel].powf(samples))
        };
        let mut all: Vec<(f64, f64)> = each.map(of_run).collect();
        // So much noise is on a sine that is slow beside the memory: of a first-order one, the root
        // of its spectrum at nought.
        let blur = |(sd, memory): &(f64, f64)| sd * ((1.0 + memory) / (1.0 - memory)).sqrt();
        all.sort_by(|a, b| blur(a).total_cmp(&blur(b)));
        all.get(all.len() / 2).copied()
    };
    [middling(0, |_| true), middling(1, |run| run.at.kind == RunKind::Forced && run.at.has_moment)]
}

/// Expected logarithm of a Bayes factor at which nine runs in ten decide: the misfits of two
/// models that lie `D` apart differ by `D` with a standard deviation of `2 sqrt(D)`, and must by
/// 12; `D - 1.28 * 2 sqrt(D) > 12` from `D = 25` on. Half as much again is for the numbers of the
/// favourite, which are not known so well.
const DECIDES: f64 = 20.0;
/// What a second run must bring to be asked for.
const WORTH_A_RUN: f64 = 2.0;
/// The same where the shape of a rival is asked for: a fifth narrower.
const WORTH_A_RUN_OF_SHAPE: f64 = 0.2;

/// The run that says most.
pub(in crate::diagnosis) fn next_run(
    survey: &Survey,
    grown: &Grown,
    tank: &Tank,
) -> Option<NextRun> {
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
            run: PlannedRun {
                kind: "rest_reading",
                froude: 0.0,
                frequency_rad_s: None,
                amplitude_deg: 0.0,
            },
            with: None,
            parts,
            expected_log_bayes_factor: 0.0,
            decides: true,
            why: "no roll test parts a heel of the model from a zero of its channel; an \
                  inclinometer read with the model at rest does"
                .to_owned(),
        });
    }
    let mut next = informing(survey, grown, tank)?;
    next.why = format!("no cause is undecided; {}", next.why);
    Some(next)
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
    let known: Vec<Known> = tried.into_iter().map(|one| Known::new(survey, one.settled)).collect();
    let known: Vec<&Known> = known.iter().collect();
    let favoured = Known::new(survey, grown.last.clone());
    let noise = noise_to_come(survey, &grown.noise);
    let only_forced = rivals.iter().any(|rival| is_one_in_decays(favourite, rival));
    let mut plans = plans(tank, survey);
    plans.retain(|(plan, _)| !only_forced || plan.kind == RunKind::Forced);
    let favoured = (favourite, &favoured);
    let alone = cores::each(plans.len(), |k| foretold(survey, favoured, &known, plans[k], noise));
    tracing::debug!(spent = survey.cost.n_spent(), runs = plans.len(), "runs foretold alone");
    let (mut log, best) = most(alone.iter().map(|told| hardest(told)))?;
    let mut set = vec![plans[best]];
    let wanted = |rival: &&Known| narrowing_wanted(survey, &rival.settled, favourite);
    let narrowing = known.iter().filter_map(wanted).reduce(f64::max);
    let (enough, worth) = match narrowing {
        Some(wanted) => (wanted, WORTH_A_RUN_OF_SHAPE),
        None => (DECIDES, WORTH_A_RUN),
    };
    if log < enough && !survey.cost.is_spent() {
        let told = |[a, b]: [usize; 2], rounds: usize| {
            let (plans, alone) = ([plans[a], plans[b]], [&alone[a][..], &alone[b]]);
            foretold_together(survey, favoured, &known, plans, alone, noise, rounds)
        };
        if let Some((both, couple)) = best_couple(&plans, best, told)
            && both > log + worth
        {
            (log, set) = (both, couple.map(|one| plans[one]).to_vec());
        }
        tracing::debug!(spent = survey.cost.n_spent(), "couples foretold");
        // Known only where couples were foretold too.
        if narrowing.is_none() && log < WORTH_A_RUN {
            return in_vain(survey, grown, tank, favourite, rivals);
        }
    }
    let mut decides = log >= enough;
    if narrowing.is_none() {
        // Any of the class may be the cause.
        log = log.min(among(survey, &known, &set, noise));
        decides = log >= DECIDES;
    }
    let w = grown.last.fit.laws[survey.condition_of[0]].numbers[0];
    let what = set.iter().map(|(plan, _)| plan.words(w)).collect::<Vec<_>>().join(" with ");
    let names = rivals.join(", ");
    let doubt = if decides { "" } else { ", which may not decide" };
    let why = if narrowing.is_some() {
        let tell = if set.len() > 1 { "tell" } else { "tells" };
        format!("{what} {tell} the shape of {names} best, and whether it is {favourite}{doubt}")
    } else {
        let part = if set.len() > 1 { "part" } else { "parts" };
        format!(
            "{what} {part} {favourite} from {names} by an expected log Bayes factor of \
             {log:.0}{doubt}"
        )
    };
    let mut runs = set.iter().map(|(plan, _)| plan.told(w));
    Some(NextRun {
        run: runs.next()?,
        with: runs.next(),
        parts: std::iter::once(favourite).chain(rivals.iter().copied()).collect(),
        expected_log_bayes_factor: if narrowing.is_some() { 0.0 } else { log },
        decides,
        why,
    })
}

/// What is worth a run where none that the tank allows parts the causes.
fn in_vain(
    survey: &Survey,
    grown: &Grown,
    tank: &Tank,
    favourite: &'static str,
    rivals: &[&'static str],
) -> Option<NextRun> {
    let mut next = informing(survey, grown, tank)?;
    next.decides = false;
    let mut ways = BESIDE_THE_TANK.iter();
    let otherwise =
        ways.find(|(pair, _)| rivals.len() == 1 && is_pair(*pair, favourite, rivals[0]));
    let otherwise = otherwise.map(|(_, what)| format!("; {what} may")).unwrap_or_default();
    let names = rivals.join(", ");
    next.why = format!(
        "no run that this tank allows is expected to part {favourite} from {names}{otherwise}; {}",
        next.why
    );
    Some(next)
}

/// The least that runs are expected to say between two rivals of a favourite, were one of them the
/// cause; infinite where there is one rival, or nothing but a shape parts them.
fn among(
    survey: &Survey,
    rivals: &[&Known],
    set: &[(Plan, f64)],
    noise: [Option<(f64, f64)>; 2],
) -> f64 {
    let id = |rival: &Known| rival.settled.fit.extensions.last().map(|e| e.effect.id);
    let is_open = |one: &Known, id| open_shapes(survey, &one.settled.fit, id).is_some();
    let logs = rivals.iter().enumerate().filter_map(|(i, cause)| {
        let others = rivals.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| *other);
        let id = id(cause)?;
        let others: Vec<&Known> = others.filter(|other| !is_open(other, id)).collect();
        let cause = (id, *cause);
        let told = |plan: &(Plan, f64)| foretold(survey, cause, &others, *plan, noise);
        let alone: Vec<Vec<Foretold>> = set.iter().map(told).collect();
        Some(match (set, alone.as_slice()) {
            ([one, two], [of_one, of_two]) => {
                let (plans, told) = ([*one, *two], [&of_one[..], of_two]);
                foretold_together(survey, cause, &others, plans, told, noise, RELINEARISED)
            }
            _ => hardest(&alone[0]),
        })
    });
    logs.fold(f64::INFINITY, f64::min)
}

/// What runs say of the rival that is hardest to part, which decides.
fn hardest(told: &[Foretold]) -> f64 {
    told.iter().map(|told| told.log).fold(f64::INFINITY, f64::min)
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
    let to_come = noise_to_come(survey, &grown.noise);
    let mut plans = plans(tank, survey);
    plans.retain(|(plan, _)| plan.kind == RunKind::Decay && plan.amplitude_deg > 0.0);
    let gains = cores::each(plans.len(), |k| {
        let (plan, span_s) = &plans[k];
        let (mut run, state, noise) = plan.observed(survey, &last.fit, *span_s, to_come);
        let fit = with_run(survey, &last.fit, &run, state.clone());
        let terms = fit.terms(survey.runs.len());
        // What it reads does not matter to what it would tell.
        run.roll_rad = vec![0.0; run.roll_time_s.len()];
        run.moment_n_m = Vec::new();
        let summary = summarise(&run, &state, &terms, &[], &noise, None);
        let grown = grown_survey(survey, vec![run]);
        let solved = Added::new((&last.fit, &known), &grown, &fit, &[summary], &scatter);
        now - volume(&solved.eliminated.covariance())
    });
    let (log, best) = most(gains.into_iter())?;
    let plan = plans[best].0;
    let w = last.fit.laws[survey.condition_of[0]].numbers[0];
    Some(NextRun {
        run: plan.told(w),
        with: None,
        parts: Vec::new(),
        expected_log_bayes_factor: log,
        decides: true,
        why: format!("{} narrows b0 and kappa most", plan.words(w)),
    })
}
