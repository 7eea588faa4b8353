//! The pipeline of samples that come live: one end takes them, the other tells what they say.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::Scope;

use devices::Sample;
use devices::channel::Counted;
use replay::Note;

use super::Options;
use super::collect::{Collector, joined};
use super::histories;
use super::listening::{FoundRun, Heard, Listening, Unheard};
use super::so_far::RunSoFar;
use super::workers::Workers;
use crate::campaign::Campaign;
use crate::diagnosis::Reversed;
use crate::results::{IdentifiedRun, Overview, Results};
use crate::run::{Aftermath, Rejection};

/// Runs that may wait to be told: more than a day has.
const QUEUE_LENGTH: usize = 256;

/// What the run finder has found in the samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// A run, which is being identified.
    Run(FoundRun),
    /// A stretch that will not be used.
    Rejected(Rejection),
}

/// The end that takes the samples; it never waits for the other.
pub struct LiveRuns<'a> {
    listening: Listening<'a>,
    heard: SyncSender<Heard>,
    n_unheard: u64,
}

/// The end that tells what the runs say, one after the other.
pub struct LiveResults<'a> {
    heard: Receiver<Heard>,
    collector: Collector<'a>,
}

/// What became of a run or a stretch.
pub enum LiveStep<'r> {
    /// A run was identified; the overview shows the recording up to its end.
    Identified {
        /// As it was found.
        found: FoundRun,
        /// What it says.
        run: &'r mut IdentifiedRun,
        /// The recording so far.
        overview: Overview,
    },
    /// A run says nothing.
    Refused {
        /// As it was found.
        found: FoundRun,
        /// Why not.
        reason: String,
        /// Where it is for the sign of its force.
        reversed: Option<Reversed>,
    },
    /// What the model did after a decay of the recording is known.
    Aftermath {
        /// Name of the recording.
        recording: &'r str,
        /// What it did.
        aftermath: Aftermath,
    },
    /// A stretch was not used, or the recording has ended.
    Noted,
    /// Results are to be told again.
    TellAgain,
}

/// The pipeline for the last recording of a campaign, whose samples are still to come.
pub fn live<'s, 'a>(
    scope: &'s Scope<'s, '_>,
    campaign: &'a Campaign,
    options: &'a Options,
) -> (LiveRuns<'a>, LiveResults<'a>) {
    let (sender, heard) = sync_channel(QUEUE_LENGTH);
    let index = campaign.recordings.len().saturating_sub(1);
    let workers = Workers::start(scope);
    let listening = Listening::new(campaign, options, &workers, index);
    let runs = LiveRuns { listening, heard: sender, n_unheard: 0 };
    (runs, LiveResults { heard, collector: Collector::new(campaign) })
}

impl LiveRuns<'_> {
    /// Takes samples in the order in which they came, and what instruments had counted when so many
    /// of them had come; appends what is known because of them.
    pub fn push(
        &mut self,
        samples: &[Sample],
        counted: &[(usize, Counted)],
        found: &mut Vec<Found>,
    ) {
        let Self { listening, heard, n_unheard } = self;
        // The telling end is gone only when it has failed, and then the recording still goes on.
        let tell = &mut |what| tell(what, heard, n_unheard, found);
        drop(listening.batch(samples, counted, tell));
    }

    /// The recording has ended, with what was lost of it; closes whatever was under way.
    pub fn end(mut self, notes: Vec<Note>, found: &mut Vec<Found>) {
        let Self { listening, heard, n_unheard } = &mut self;
        drop(listening.end(notes, &mut |what| tell(what, heard, n_unheard, found)));
    }

    /// Asks the other end to tell its results once more.
    pub fn tell_again(&self) {
        // A full queue brings its own results soon.
        self.heard.try_send(Heard::TellAgain).ok();
    }

    /// The run under way as it would be if the recording ended now.
    pub fn so_far(&self) -> Option<RunSoFar> {
        self.listening.so_far()
    }

    /// Whether neither a run nor any motion is under way.
    pub fn is_at_rest(&self) -> bool {
        self.listening.is_at_rest()
    }

    /// Runs that found no place in the queue; a replay of the recording has them.
    pub fn n_unheard(&self) -> u64 {
        self.n_unheard
    }
}

fn tell(
    what: Heard,
    heard: &SyncSender<Heard>,
    n_unheard: &mut u64,
    found: &mut Vec<Found>,
) -> Result<(), Unheard> {
    match &what {
        Heard::Run { found: run, .. } => found.push(Found::Run(run.clone())),
        Heard::Rejected { rejection, .. } => found.push(Found::Rejected(rejection.clone())),
        _ => {}
    }
    match heard.try_send(what) {
        Ok(()) => Ok(()),
        Err(TrySendError::Full(_)) => {
            *n_unheard += 1;
            Ok(())
        }
        Err(TrySendError::Disconnected(_)) => Err(Unheard),
    }
}

impl LiveResults<'_> {
    /// Waits for what comes next; none when the recording has ended and all is told.
    pub fn next_step(&mut self) -> Option<LiveStep<'_>> {
        Some(match self.heard.recv().ok()? {
            Heard::Covered { .. } | Heard::Read { .. } => LiveStep::Noted,
            Heard::TellAgain => LiveStep::TellAgain,
            Heard::Run { index, found, identified, overview } => {
                // A worker that panicked has no answer, and the scope passes its panic on.
                let identified = identified.recv().ok()?;
                let reversed = identified.reversed(self.collector.campaign());
                let reason = identified.identification.as_ref().err().cloned();
                if let Some(run) = self.collector.keep(index, identified, &found.brought) {
                    LiveStep::Identified { found, run, overview }
                } else {
                    let reason = reason.unwrap_or_default();
                    LiveStep::Refused { found, reason, reversed }
                }
            }
            Heard::Rejected { index, rejection } => {
                self.collector.reject(index, rejection);
                LiveStep::Noted
            }
            Heard::Aftermath { index, aftermath } => {
                LiveStep::Aftermath { recording: self.collector.recording(index), aftermath }
            }
            Heard::Ended { overview, .. } => {
                self.collector.end_recording(overview);
                LiveStep::Noted
            }
        })
    }

    /// What this recording has taught so far, behind what earlier ones did; nothing is judged and
    /// no law drawn yet, which [`super::judged`] does.
    pub fn results(&self, earlier: &Results) -> Results {
        joined(earlier, self.collector.so_far())
    }
}

/// Keeps the numbers of a run whose page is written, and lets its histories go.
pub fn forget_histories(run: &mut IdentifiedRun) {
    histories::drop_from(run);
}
