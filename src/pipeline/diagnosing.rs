//! Gathering the runs of a campaign for the diagnosis while they are identified.

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

use super::Learnt;
use super::histories;
use super::shelf::{Lying, Shelf};
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
    /// Where series lie; none keeps them in memory.
    shelf: Option<Arc<RwLock<Shelf>>>,
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
    alone: Shelved,
    /// The same with what the model did after it.
    whole: Option<Shelved>,
    /// Whether it lies in what the model did after an earlier one.
    is_within: bool,
}

/// An observation with the place of its series, when they are not with it.
#[derive(Debug, Clone)]
struct Shelved {
    observation: Observation,
    lying: Option<Lying>,
}

/// What is remembered of a run until it is known what came after it.
#[derive(Debug, Clone)]
struct LastHeard {
    run: IdentifiedRun,
    order: usize,
}

impl LastHeard {
    /// A run without the histories that only its page shows.
    fn of(run: &IdentifiedRun, order: usize) -> Self {
        let mut remembered = run.clone();
        histories::drop_from(&mut remembered);
        remembered.run.roll.clone_from(&run.run.roll);
        remembered.run.drive.clone_from(&run.run.drive);
        Self { run: remembered, order }
    }

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
    run.run.lead.time_s.retain(|t| *t < time_s[0]);
    run.run.lead.value.truncate(run.run.lead.time_s.len());
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
    /// Nothing heard yet; what a diagnosis reads sample by sample waits for it on the disk of a
    /// folder, so that a day of runs takes no memory.
    ///
    /// # Errors
    /// What the system said when there can be no file.
    pub fn on_disk(folder: &Path) -> io::Result<Self> {
        let shelf = Some(Arc::new(RwLock::new(Shelf::in_folder(folder)?)));
        Ok(Self { shelf, ..Self::default() })
    }

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
        self.last.push_back(LastHeard::of(run, self.n_runs));
        match observation {
            Ok(alone) => {
                let (start_s, end_s) = (run.run.start_s, run.run.end_s);
                let place = Place { recording: run.recording.clone(), start_s, end_s };
                let alone = self.put_down(alone);
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
        let whole = whole.ok().map(|whole| self.put_down(whole));
        for seen in &mut self.observations {
            if seen.alone.observation.id == id {
                seen.whole.clone_from(&whole);
            } else {
                seen.is_within |=
                    seen.place.recording == recording && lies_within(seen.place.start_s);
            }
        }
    }

    /// Puts the series of a run on the shelf; where there is no room for them they stay with it.
    fn put_down(&self, mut observation: Observation) -> Shelved {
        let Some(shelf) = &self.shelf else { return Shelved { observation, lying: None } };
        let mut shelf = shelf.write().unwrap_or_else(PoisonError::into_inner);
        let put = shelf.put(&observation.series_mut().map(|values| values.as_slice()));
        let lying = put.inspect_err(|error| tracing::warn!("kept in memory: {error}")).ok();
        if lying.is_some() {
            observation.series_mut().into_iter().for_each(|values| *values = Vec::new());
        }
        Shelved { observation, lying }
    }

    /// A run with its series, wherever they are; none when its disk does not give them back.
    fn taken_up(shelf: Option<&Shelf>, shelved: &Shelved) -> Option<Observation> {
        let Shelved { mut observation, lying } = shelved.clone();
        if let Some((shelf, lying)) = shelf.zip(lying) {
            let series = shelf.get(&lying).inspect_err(|error| {
                tracing::error!(run = observation.id, "left out of the diagnosis: {error}");
            });
            for (values, again) in observation.series_mut().into_iter().zip(series.ok()?) {
                *values = again;
            }
        }
        Some(observation)
    }

    /// The same without the runs that were rejected by hand.
    #[must_use]
    pub fn judged(mut self, judgements: &Judgements) -> Self {
        let left_out = &mut self.left_out;
        self.observations.retain(|Seen { place, alone, .. }| {
            let rejection = judgements.rejection(&place.recording, place.start_s, place.end_s);
            left_out.extend(rejection.map(|rejection| {
                format!("{}: rejected by hand by {}", alone.observation.id, rejection.by)
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
            let shelf = self.shelf.as_deref().map(RwLock::read);
            let shelf = shelf.map(|shelf| shelf.unwrap_or_else(PoisonError::into_inner));
            let take = |shelved: &Shelved| Self::taken_up(shelf.as_deref(), shelved);
            let has_more = self.observations.iter().any(|seen| seen.whole.is_some());
            let begun = || self.observations.iter().filter(|seen| !seen.is_within);
            let whole = begun().filter(|_| has_more);
            let whole = whole.filter_map(|seen| take(seen.whole.as_ref().unwrap_or(&seen.alone)));
            let whole = whole.collect();
            let runs = begun().filter_map(|seen| take(&seen.alone)).collect();
            drop(shelf);
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

    /// Memory that the series of its runs take between two diagnoses [bytes], beside the records
    /// of the last few, of which it is not known yet what came after them.
    pub fn series_bytes(&self) -> usize {
        let of = |Shelved { observation: one, .. }: &Shelved| {
            let series = [&one.roll_time_s, &one.roll_rad, &one.moment_time_s, &one.moment_n_m];
            series.map(|values| size_of::<f64>() * values.capacity()).iter().sum::<usize>()
        };
        let each = self.observations.iter();
        each.map(|seen| of(&seen.alone) + seen.whole.as_ref().map_or(0, of)).sum()
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
        let kind = |Seen { alone, .. }: &Seen| -> (String, RunKind, [i64; 3]) {
            let run = &alone.observation;
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
