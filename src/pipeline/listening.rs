//! One stream of samples on its way through the run finder, recorded or live.

use std::collections::BTreeMap;
use std::sync::mpsc::Receiver;

use devices::channel::{Brought, Counted, Tally};
use devices::{Quantity, Sample};
use replay::Note;

use super::Options;
use super::asking::Asking;
use super::overview::OverviewBuilder;
use super::so_far::RunSoFar;
use super::workers::{Identified, Workers};
use crate::campaign::{Campaign, Recording};
use crate::results::Overview;
use crate::run::{Aftermath, Event, Limits, Rejection, RunEnd, RunFinder, RunKind, Timing};

/// Longest time before the end of a rest in which the next run may begin [s], with a margin.
const AT_REST_S: f64 = 60.0;

/// What a stream tells whoever collects its runs.
pub(super) enum Heard {
    /// The next batch of samples covers this stretch [s] of absolute time.
    Covered { start_s: f64, end_s: f64 },
    /// A batch of samples has been read; bytes of this recording so far.
    Read { index: usize, bytes_read: u64 },
    /// A run has ended and is being identified; the overview shows the recording up to here.
    Run { index: usize, found: FoundRun, identified: Receiver<Identified>, overview: Overview },
    /// A stretch will not be used.
    Rejected { index: usize, rejection: Rejection },
    /// What the model did after a decay is known.
    Aftermath { index: usize, aftermath: Aftermath },
    /// Results are to be told again.
    TellAgain,
    /// The recording has ended.
    Ended { overview: Overview, notes: Vec<Note> },
}

/// A run as it was found, before it is known what it says.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundRun {
    /// Its number in the recording, counted from 1.
    pub number: u64,
    /// Decay or forced.
    pub kind: RunKind,
    /// First instant used [s].
    pub start_s: f64,
    /// Last instant used [s].
    pub end_s: f64,
    /// Why it ends there.
    pub end: RunEnd,
    /// What the instruments brought on each channel from its start to its end.
    pub brought: Vec<Brought>,
}

/// The listener has gone away, so there is nobody to play for.
pub(super) struct Unheard;

/// Whoever is told.
pub(super) type Tell<'t> = dyn FnMut(Heard) -> Result<(), Unheard> + 't;

/// A stream under way.
pub(super) struct Listening<'a> {
    index: usize,
    recording: &'a str,
    finder: RunFinder,
    events: Vec<Event>,
    overview: OverviewBuilder,
    tallies: BTreeMap<Quantity, Tally>,
    drive_is_moment: bool,
    asking: Asking<'a>,
    n_found: u64,
}

impl<'a> Listening<'a> {
    /// At the start of the recording at `index`.
    pub(super) fn new(
        campaign: &'a Campaign,
        options: &'a Options,
        workers: &Workers,
        index: usize,
    ) -> Self {
        let recording = &campaign.recordings[index];
        Self {
            index,
            recording: &recording.name,
            finder: RunFinder::new(limits(campaign, recording)),
            events: Vec::new(),
            overview: OverviewBuilder::default(),
            tallies: BTreeMap::new(),
            drive_is_moment: false,
            asking: Asking::new(campaign, options, workers, index),
            n_found: 0,
        }
    }

    /// Whether neither a run nor any motion is under way.
    pub(super) fn is_at_rest(&self) -> bool {
        self.finder.is_at_rest()
    }

    /// The run under way as it would be found and asked about if the stream ended now.
    pub(super) fn so_far(&self) -> Option<RunSoFar> {
        let mut run = self.finder.so_far()?;
        run.timing = self.timing(run.start_s, run.end_s);
        Some(RunSoFar {
            number: self.n_found + 1,
            setting: self.asking.setting(run.kind, self.drive_is_moment).ok()?,
            index: self.index,
            brought: self.brought(run.start_s, run.end_s),
            overview: self.overview.so_far(self.recording, Vec::new()),
            run,
        })
    }

    /// Takes samples in the order in which they came, and what instruments had counted when so many
    /// of them had come.
    pub(super) fn batch(
        &mut self,
        samples: &[Sample],
        counted: &[(usize, Counted)],
        tell: &mut Tell<'_>,
    ) -> Result<(), Unheard> {
        let mut counted = counted.iter().peekable();
        for (n_before, sample) in samples.iter().enumerate() {
            while let Some((_, counted)) = counted.next_if(|(at, _)| *at <= n_before) {
                self.count(counted);
            }
            self.drive_is_moment |= sample.quantity == Quantity::Moment;
            self.overview.push(sample);
            self.finder.push(sample, &mut self.events);
            if !self.events.is_empty() {
                self.tell_events(tell)?;
            }
        }
        counted.for_each(|(_, counted)| self.count(counted));
        Ok(())
    }

    fn count(&mut self, counted: &Counted) {
        let quantity = counted.quantity;
        let tally = self.tallies.entry(quantity).or_insert_with(|| Tally::new(quantity));
        tally.note(counted);
        if self.finder.is_at_rest() {
            tally.forget_before(counted.time_s - AT_REST_S);
        }
    }

    /// The stream has ended; `notes` say what was lost of it.
    pub(super) fn end(&mut self, notes: Vec<Note>, tell: &mut Tell<'_>) -> Result<(), Unheard> {
        self.finder.finish(&mut self.events);
        self.tell_events(tell)?;
        let messages = notes.iter().map(|note| note.message.clone()).collect();
        let overview = self.overview.so_far(self.recording, messages);
        tell(Heard::Ended { overview, notes })
    }

    fn tell_events(&mut self, tell: &mut Tell<'_>) -> Result<(), Unheard> {
        for event in std::mem::take(&mut self.events) {
            let index = self.index;
            tell(match event {
                Event::Run(mut run) => {
                    self.n_found += 1;
                    run.timing = self.timing(run.start_s, run.end_s);
                    Heard::Run {
                        index,
                        found: FoundRun {
                            number: self.n_found,
                            kind: run.kind,
                            start_s: run.start_s,
                            end_s: run.end_s,
                            end: run.end,
                            brought: self.brought(run.start_s, run.end_s),
                        },
                        identified: self.asking.identify(run, self.drive_is_moment),
                        overview: self.overview.so_far(self.recording, Vec::new()),
                    }
                }
                Event::Rejected(rejection) => Heard::Rejected { index, rejection },
                Event::Aftermath(aftermath) => Heard::Aftermath { index, aftermath },
            })?;
        }
        Ok(())
    }

    fn brought(&self, start_s: f64, end_s: f64) -> Vec<Brought> {
        self.tallies.values().map(|tally| tally.between(start_s, end_s)).collect()
    }

    fn timing(&self, start_s: f64, end_s: f64) -> Timing {
        let drive = if self.drive_is_moment { Quantity::Moment } else { Quantity::Force };
        let tallies = [Quantity::Roll, drive].map(|quantity| self.tallies.get(&quantity));
        let [roll_bound_s, drive_bound_s] =
            tallies.map(|tally| tally?.between(start_s, end_s).bound_s);
        let is_common = match tallies {
            [Some(roll), Some(drive)] => roll.is_stamped_with(drive, start_s, end_s),
            _ => false,
        };
        Timing { roll_bound_s, drive_bound_s, is_common }
    }
}

fn limits(campaign: &Campaign, recording: &Recording) -> Limits {
    Limits {
        carriage_max_speed_m_s: campaign.tank.carriage_max_speed_m_s,
        declared_speed_m_s: recording.speed_m_s,
        length_pp_m: campaign.hull.length_pp_m,
        gravity_m_s2: campaign.water.gravity_m_s2,
    }
}
