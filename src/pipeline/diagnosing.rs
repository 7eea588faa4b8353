//! Gathering the runs of a campaign for the diagnosis while they are identified.

use std::f64::consts::TAU;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

use super::shelf::{Lying, Shelf};
use crate::campaign::Campaign;
use crate::diagnosis::{self, Diagnosis, Observation};
use crate::judgement::{Judgements, Place};
use crate::results::IdentifiedRun;
use crate::run::RunKind;

/// Most runs that are diagnosed together: more repeat each other, and a diagnosis takes time with
/// their square.
const MOST_RUNS: usize = 100;
/// Periods within which nobody brings a model to rest, heels it and lets it go.
const PERIODS_TO_RELEASE: f64 = 4.0;
/// Runs this near in Froude number and roll [rad] are repeats.
const NEAR: [f64; 2] = [0.02, 0.03];

/// What the diagnosis will see of the runs heard so far.
#[derive(Debug, Clone, Default)]
pub struct Observed {
    observations: Vec<Heard>,
    /// Where series lie; none keeps them in memory.
    shelf: Option<Arc<RwLock<Shelf>>>,
    left_out: Vec<String>,
    last: Option<LastHeard>,
    n_heard: usize,
    n_repeats: usize,
}

/// A run that takes part.
#[derive(Debug, Clone)]
struct Heard {
    place: Place,
    observation: Observation,
    /// Where its series are, when they are not with it.
    lying: Option<Lying>,
}

/// What is remembered of the run heard last.
#[derive(Debug, Clone)]
struct LastHeard {
    id: String,
    recording: String,
    kind: RunKind,
    end_s: f64,
}

impl LastHeard {
    /// Whether a decay is a later part of this one: what water in the hull or a memory did before
    /// it began is not known.
    fn goes_on_in(&self, run: &IdentifiedRun) -> bool {
        let period_s = TAU / run.identification.natural_frequency_rad_s.mean;
        let after_s = run.run.start_s - self.end_s;
        let are_decays = self.kind == RunKind::Decay && run.run.kind == RunKind::Decay;
        let is_near = (0.0..PERIODS_TO_RELEASE * period_s).contains(&after_s);
        are_decays && is_near && self.recording == run.recording
    }
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

    /// Takes a run whose histories are still with it.
    pub fn hear(&mut self, run: &IdentifiedRun, campaign: &Campaign) {
        let observation = match self.last.as_ref().filter(|last| last.goes_on_in(run)) {
            Some(last) => Err(format!("it goes on from {}, and did not begin at rest", last.id)),
            None => Observation::new(run, campaign, self.n_heard),
        };
        self.last = Some(LastHeard {
            id: run.id.clone(),
            recording: run.recording.clone(),
            kind: run.run.kind,
            end_s: run.run.end_s,
        });
        match observation {
            Ok(observation) => {
                let (start_s, end_s) = (run.run.start_s, run.run.end_s);
                let place = Place { recording: run.recording.clone(), start_s, end_s };
                let heard = Heard { place, observation, lying: None };
                self.observations.push(self.put_down(heard));
            }
            Err(reason) => self.left_out.push(format!("{}: {reason}", run.id)),
        }
        self.n_heard += 1;
        if self.observations.len() > MOST_RUNS {
            self.let_go_of_a_repeat();
        }
    }

    /// Puts the series of a run on the shelf; where there is no room for them they stay with it.
    fn put_down(&self, heard: Heard) -> Heard {
        let Some(shelf) = &self.shelf else { return heard };
        let mut shelf = shelf.write().unwrap_or_else(PoisonError::into_inner);
        let Heard { place, mut observation, .. } = heard;
        let put = shelf.put(&observation.series_mut().map(|values| values.as_slice()));
        let lying = put.inspect_err(|error| tracing::warn!("kept in memory: {error}")).ok();
        if lying.is_some() {
            observation.series_mut().into_iter().for_each(|values| *values = Vec::new());
        }
        Heard { place, observation, lying }
    }

    /// A run with its series, wherever they are; none when its disk does not give them back.
    fn taken_up(shelf: Option<&Shelf>, heard: Heard) -> Option<Observation> {
        let Heard { mut observation, lying, .. } = heard;
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
        self.observations.retain(|Heard { place, observation, .. }| {
            let Place { recording, start_s, end_s } = place;
            let rejection = judgements.rejection(recording, *start_s, *end_s);
            left_out.extend(rejection.map(|rejection| {
                format!("{}: rejected by hand by {}", observation.id, rejection.by)
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
            let take = |heard| Self::taken_up(shelf.as_deref(), heard);
            let observations = self.observations.into_iter().filter_map(take).collect();
            drop(shelf);
            diagnosis::diagnose(observations, &campaign.tank)
        }));
        diagnosed.unwrap_or_else(|_| {
            tracing::error!(
                "the diagnosis failed, and nothing else did; hint: send the developers the \
                 campaign folder, and diagnose fewer recordings meanwhile"
            );
            None
        })
    }

    /// Memory that its series take between two diagnoses [bytes].
    pub fn series_bytes(&self) -> usize {
        let of = |Heard { observation: one, .. }: &Heard| {
            let series = [&one.roll_time_s, &one.roll_rad, &one.moment_time_s, &one.moment_n_m];
            series.map(|values| size_of::<f64>() * values.capacity()).iter().sum::<usize>()
        };
        self.observations.iter().map(of).sum()
    }

    /// Whether no run is left to be diagnosed.
    pub fn is_empty(&self) -> bool {
        self.observations.is_empty()
    }

    /// Runs heard so far.
    pub fn n_heard(&self) -> usize {
        self.n_heard
    }

    /// Lets go of the second of the runs that have most like them: the first and the last stay.
    fn let_go_of_a_repeat(&mut self) {
        let kind = |Heard { observation: run, .. }: &Heard| -> (String, RunKind, [i64; 3]) {
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
