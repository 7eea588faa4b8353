//! Gathering the runs of a campaign for the diagnosis while they are identified.

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::Learnt;
use crate::campaign::Campaign;
use crate::diagnosis::{self, Diagnosis, Gathered, Observation, Reversed};
use crate::judgement::{Judgements, Place};
use crate::results::IdentifiedRun;
use crate::run::{Aftermath, Run, RunKind, Series};

/// Most runs that are diagnosed together: more repeat each other, and a diagnosis takes time with
/// their square.
const MOST_RUNS: usize = 100;
/// Periods within which nobody brings a model to rest, heels it and lets it go.
const PERIODS_TO_RELEASE: f64 = 4.0;
/// Runs that are remembered until it is known what came after them.
const MOST_REMEMBERED: usize = 4;
/// Runs this near in Froude number and roll [rad] are repeats.
const NEAR: [f64; 2] = [0.02, 0.03];

/// What the diagnosis will see of the runs heard so far.
#[derive(Debug, Clone, Default)]
pub struct Observed {
    observations: Vec<Seen>,
    reversed: Vec<Reversed>,
    left_out: Vec<String>,
    /// The last runs, of which it is not known yet what came after them.
    last: VecDeque<LastHeard>,
    n_runs: usize,
    n_heard: usize,
    n_repeats: usize,
}

/// A run that takes part.
#[derive(Debug, Clone)]
struct Seen {
    place: Place,
    alone: Observation,
    /// The same with what the model did after it.
    whole: Option<Observation>,
    /// Whether it lies in what the model did after an earlier one.
    is_within: bool,
}

/// What is remembered of a run until it is known what came after it.
#[derive(Debug, Clone)]
struct LastHeard {
    run: IdentifiedRun,
    order: usize,
}

impl LastHeard {
    /// Whether a decay is a later part of this one: what water in the hull or a memory did before
    /// it began is not known.
    fn goes_on_in(&self, run: &IdentifiedRun) -> bool {
        let period_s = TAU / run.identification.natural_frequency_rad_s.mean;
        let after_s = run.run.start_s - self.run.run.end_s;
        let are_decays = self.run.run.kind == RunKind::Decay && run.run.kind == RunKind::Decay;
        let is_near = (0.0..PERIODS_TO_RELEASE * period_s).contains(&after_s);
        are_decays && is_near && self.run.recording == run.recording
    }
}

/// Adds samples behind those of a channel.
fn append(series: &mut Series, later: &Series) {
    series.time_s.extend_from_slice(&later.time_s);
    series.value.extend_from_slice(&later.value);
}

/// Lets a run begin with the release before it.
fn begin_with(run: &mut IdentifiedRun, release: &Aftermath) {
    let Series { time_s, value } = &release.roll;
    run.run.start_s = time_s[0];
    run.run.roll = release.roll.clone();
    run.run.drive = release.drive.clone();
    let known = &mut run.identification;
    let rolling_rad_s = known.natural_frequency_rad_s.mean;
    // A straight line through the first twentieth of a period is near enough to start from.
    let line_s = 0.05 * TAU / rolling_rad_s;
    let n = time_s.partition_point(|t| *t < time_s[0] + line_s).clamp(2, time_s.len());
    let rate = (value[n - 1] - value[0]) / (time_s[n - 1] - time_s[0]).max(1e-6);
    known.initial_roll_rad.mean = value[0];
    known.initial_roll_rate_rad_per_s.mean = rate;
}

impl Observed {
    /// Takes a run whose histories are still with it, or what came after one.
    pub fn hear(&mut self, learnt: Learnt<'_>, campaign: &Campaign) {
        match learnt {
            Learnt::Run(run, _) => self.hear_run(run, campaign),
            Learnt::Aftermath(recording, after) => self.hear_after(recording, after, campaign),
            Learnt::Reversed(reversed) => {
                self.reversed.push(reversed.clone());
                self.n_heard += 1;
            }
        }
    }

    fn hear_run(&mut self, run: &IdentifiedRun, campaign: &Campaign) {
        let before = self.last.back().filter(|last| last.goes_on_in(run));
        let observation = match before {
            Some(last) => {
                Err(format!("it goes on from {}, and did not begin at rest", last.run.id))
            }
            None => Observation::new(run, campaign, self.n_runs),
        };
        if self.last.len() == MOST_REMEMBERED {
            self.last.pop_front();
        }
        self.last.push_back(LastHeard { run: run.clone(), order: self.n_runs });
        match observation {
            Ok(alone) => {
                let (start_s, end_s) = (run.run.start_s, run.run.end_s);
                let place = Place { recording: run.recording.clone(), start_s, end_s };
                self.observations.push(Seen { place, alone, whole: None, is_within: false });
            }
            Err(reason) => self.left_out.push(format!("{}: {reason}", run.id)),
        }
        self.n_runs += 1;
        self.n_heard += 1;
        if self.observations.len() > MOST_RUNS {
            self.let_go_of_a_repeat();
        }
    }

    /// Joins what the model did after a release to the run that began with it, later runs in it
    /// included; where none began with it, the first of those stands for the release.
    fn hear_after(&mut self, recording: &str, after: &Aftermath, campaign: &Campaign) {
        self.n_heard += 1;
        let [Some(first_s), Some(last_s)] = [after.roll.time_s.first(), after.roll.time_s.last()]
        else {
            return;
        };
        tracing::debug!(recording, first_s, last_s, run_end_s = after.run_end_s, "came after");
        let lies_within = |start_s: f64| (*first_s..*last_s).contains(&start_s);
        let is_its_own = |run: &Run| match after.run_end_s {
            Some(end_s) => run.end_s.to_bits() == end_s.to_bits(),
            None => run.kind == RunKind::Decay && lies_within(run.start_s),
        };
        let is_of =
            |last: &&LastHeard| last.run.recording == recording && is_its_own(&last.run.run);
        let Some(LastHeard { run, order }) = self.last.iter().find(is_of) else { return };
        let (id, mut whole) = (run.id.clone(), run.clone());
        match after.run_end_s {
            Some(_) => {
                append(&mut whole.run.roll, &after.roll);
                append(&mut whole.run.drive, &after.drive);
            }
            None => begin_with(&mut whole, after),
        }
        let whole = Observation::new(&whole, campaign, *order);
        if let Err(reason) = &whole {
            tracing::debug!(id, reason, "not joined");
        }
        for seen in &mut self.observations {
            if seen.alone.id == id {
                seen.whole = whole.clone().ok();
            } else {
                seen.is_within |=
                    seen.place.recording == recording && lies_within(seen.place.start_s);
            }
        }
    }

    /// The same without the runs that were rejected by hand.
    #[must_use]
    pub fn judged(mut self, judgements: &Judgements) -> Self {
        let left_out = &mut self.left_out;
        self.observations.retain(|Seen { place, alone, .. }| {
            let rejection = judgements.rejection(&place.recording, place.start_s, place.end_s);
            left_out
                .extend(rejection.map(|rejection| {
                    format!("{}: rejected by hand by {}", alone.id, rejection.by)
                }));
            rejection.is_none()
        });
        self
    }

    /// The runs that take no part, each with its reason, as sentences.
    pub fn left_out(&self) -> Vec<String> {
        let mut all = self.left_out.clone();
        if self.n_repeats > 0 {
            all.push(format!(
                "{} runs that repeat others: the diagnosis looks at {MOST_RUNS} of all kinds",
                self.n_repeats
            ));
        }
        all
    }

    /// What the runs say; none without runs.
    ///
    /// A fault of the diagnosis is told and costs nothing else: neither report nor daemon may end
    /// because of it.
    pub fn diagnosed(self, campaign: &Campaign) -> Option<Diagnosis> {
        let diagnosed = catch_unwind(AssertUnwindSafe(|| {
            let has_more = self.observations.iter().any(|seen| seen.whole.is_some());
            let whole = self.observations.iter().filter(|seen| has_more && !seen.is_within);
            let whole = whole.map(|seen| seen.whole.as_ref().unwrap_or(&seen.alone).clone());
            let whole = whole.collect();
            let runs = self.observations.into_iter().map(|seen| seen.alone).collect();
            let gathered = Gathered { runs, whole, reversed: self.reversed };
            diagnosis::diagnose(gathered, &campaign.tank)
        }));
        diagnosed.unwrap_or_else(|_| {
            tracing::error!(
                "the diagnosis failed, and nothing else did; hint: send the developers the \
                 campaign folder, and diagnose fewer recordings meanwhile"
            );
            None
        })
    }

    /// Whether no run is left to be diagnosed.
    pub fn is_empty(&self) -> bool {
        self.observations.is_empty()
    }

    /// Runs and what came after them, heard so far.
    pub fn n_heard(&self) -> usize {
        self.n_heard
    }

    /// Lets go of the second of the runs that have most like them: the first and the last stay.
    fn let_go_of_a_repeat(&mut self) {
        let kind = |Seen { alone: run, .. }: &Seen| -> (String, RunKind, [i64; 3]) {
            let at = &run.at;
            let place = |value: f64, near: f64| (value / near).round() as i64;
            let rolling = if at.kind == RunKind::Forced { place(at.rolling_rad_s, 0.2) } else { 0 };
            let places = [place(at.froude, NEAR[0]), place(at.amplitude_rad, NEAR[1]), rolling];
            (run.condition.clone(), at.kind, places)
        };
        let kinds: Vec<_> = self.observations.iter().map(kind).collect();
        let count = |i: usize| kinds.iter().filter(|kind| **kind == kinds[i]).count();
        let most =
            (0..kinds.len()).map(|i| (count(i), i)).max_by_key(|(n, i)| (*n, usize::MAX - i));
        let Some((_, first)) = most else { return };
        let second = (first + 1..kinds.len()).find(|i| kinds[*i] == kinds[first]);
        self.observations.remove(second.unwrap_or(first));
        self.n_repeats += 1;
    }
}
