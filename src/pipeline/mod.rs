//! From recordings to results: play, find runs, identify each as it ends.
//!
//! One thread reads and finds runs, one per core identifies them, and the caller's thread takes
//! them in the order in which they ended; short queues between keep the memory bounded.

mod appendix;
mod asking;
mod claims;
mod collect;
mod diagnosing;
mod error;
mod files;
mod histories;
mod judging;
mod listening;
mod live;
mod names;
mod overview;
mod play;
mod printing;
mod read_ahead;
mod sha256;
mod shelf;
mod so_far;
mod survey;
mod workers;

use std::sync::mpsc;
use std::thread;

use replay::Note;

use crate::campaign::Campaign;
use crate::diagnosis::Reversed;
use crate::inverse::identification::Method;
use crate::results::{IdentifiedRun, Overview, Results};
use crate::run::Aftermath;

pub use appendix::write_appendix;
pub use diagnosing::Observed;
pub use error::PipelineError;
pub use files::{REPORT_PAGE, WriteError, results_folder, write_results, write_run_page};
pub use judging::judged;
pub use listening::FoundRun;
pub use live::{Found, LiveResults, LiveRuns, LiveStep, forget_histories, live};
pub use names::labels;
pub use printing::{BROWSER_VARIABLE, PRINTED_REPORT, PrintError, print_report};
pub use so_far::RunSoFar;
pub use survey::{Surveyed, survey};

use collect::Collector;
use listening::Heard;
use play::size_bytes;
use workers::Workers;

/// How a campaign is replayed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// How the moment history of each run is inferred.
    pub method: Method,
    /// Seed of everything random.
    pub seed: u64,
    /// Recorded seconds played in one second [-]; none plays as fast as it goes.
    pub speed: Option<f64>,
    /// Whether the histories of every run are kept after the listener has seen them; a day has more
    /// of them than memory.
    pub keep_histories: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { method: Method::Exact, seed: 1, speed: None, keep_histories: true }
    }
}

/// How far a replay has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress<'p> {
    /// More of a recording has been read.
    Read {
        /// Name of the recording.
        recording: &'p str,
        /// Bytes read of all recordings.
        bytes_read: u64,
        /// Bytes of all recordings.
        bytes_total: u64,
        /// Runs identified so far.
        n_runs: usize,
    },
    /// A recording has ended.
    Ended {
        /// Name of the recording.
        recording: &'p str,
        /// What was mended or lost while reading it.
        notes: &'p [Note],
    },
}

/// What a replay has learnt of a recording.
#[derive(Debug, Clone, Copy)]
pub enum Learnt<'l> {
    /// A run was identified; the overview shows the recording up to its end.
    Run(&'l IdentifiedRun, &'l Overview),
    /// What the model did after a decay of the recording.
    Aftermath(&'l str, &'l Aftermath),
    /// A forced run was refused for the sign of its force.
    Reversed(&'l Reversed),
}

/// An error of whoever listens to the runs.
pub type ListenerError = Box<dyn std::error::Error + Send + Sync>;

/// Messages between two threads: enough to keep both busy, few enough to bound the memory.
const QUEUE_LENGTH: usize = 8;

/// Replays every recording of a campaign and identifies its runs.
///
/// Each run is told to `listener` at once.
///
/// # Errors
/// [`PipelineError`] at the first recording that cannot be read, two recordings that overlap in
/// time, or the first error of the listener.
pub fn replay(
    campaign: &Campaign,
    options: &Options,
    progress: &mut dyn FnMut(Progress<'_>),
    listener: &mut dyn FnMut(Learnt<'_>) -> Result<(), ListenerError>,
) -> Result<Results, PipelineError> {
    let (heard, queue) = mpsc::sync_channel(QUEUE_LENGTH);
    let sizes: Vec<u64> = campaign.recordings.iter().map(size_bytes).collect();
    let bytes_total = sizes.iter().sum();
    thread::scope(|scope| {
        let workers = Workers::start(scope);
        scope.spawn(move || read_ahead::campaign(campaign, options, &workers, &heard));
        let mut collector = Collector::new(campaign);
        for message in queue {
            match message? {
                Heard::Covered { .. } | Heard::TellAgain => {}
                Heard::Read { index, bytes_read } => progress(Progress::Read {
                    recording: &campaign.recordings[index].name,
                    bytes_read: sizes[..index].iter().sum::<u64>() + bytes_read,
                    bytes_total,
                    n_runs: collector.n_runs(),
                }),
                Heard::Run { index, found, identified, overview } => {
                    // A worker that panicked has no answer, and the scope passes its panic on.
                    let Ok(identified) = identified.recv() else { break };
                    if let Some(reversed) = identified.reversed(campaign) {
                        let recording = &campaign.recordings[index].name;
                        listener(Learnt::Reversed(&reversed)).map_err(of_listener(recording))?;
                    }
                    if let Some(run) = collector.keep(index, identified, &found.brought) {
                        listener(Learnt::Run(run, &overview)).map_err(of_listener(&run.id))?;
                        if !options.keep_histories {
                            histories::drop_from(run);
                        }
                    }
                }
                Heard::Rejected { index, rejection } => collector.reject(index, rejection),
                Heard::Aftermath { index, aftermath } => {
                    let recording = &campaign.recordings[index].name;
                    let learnt = Learnt::Aftermath(recording, &aftermath);
                    listener(learnt).map_err(of_listener(recording))?;
                }
                Heard::Ended { overview, notes } => {
                    progress(Progress::Ended { recording: &overview.recording, notes: &notes });
                    collector.end_recording(overview);
                }
            }
        }
        Ok(collector.into_results())
    })
}

fn of_listener(what: &str) -> impl FnOnce(ListenerError) -> PipelineError {
    move |source| PipelineError::Listener { run: what.to_owned(), source }
}

/// The recordings in which no run could be identified, as sentences that say why.
pub fn without_runs(results: &Results) -> Vec<String> {
    let empty = results.overviews.iter().filter(|overview| !has_run(results, &overview.recording));
    empty.map(|overview| without_run(overview, results)).collect()
}

fn without_run(Overview { recording, roll, .. }: &Overview, results: &Results) -> String {
    let rejected = results.rejected.iter().filter(|stretch| stretch.recording == *recording);
    let n_rejected = rejected.count();
    if n_rejected > 0 {
        let stretches = if n_rejected == 1 { "stretch" } else { "stretches" };
        return format!(
            "recording \"{recording}\" gave no run: {n_rejected} rejected {stretches} told with \
             the results"
        );
    }
    let (Some(first_s), Some(last_s)) = (roll.time_s.first(), roll.time_s.last()) else {
        return format!("recording \"{recording}\" gave no run: it holds no roll");
    };
    let low_rad = roll.value.iter().copied().fold(f64::INFINITY, f64::min);
    let high_rad = roll.value.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!(
        "recording \"{recording}\" gave no run: {:.3} s with roll from {:.3} to {:.3} deg; hint: \
         check the units of roll and time in [columns]",
        last_s - first_s,
        low_rad.to_degrees(),
        high_rad.to_degrees()
    )
}

/// Whether a listed recording, or the campaign as a whole, gave no run.
///
/// A single recording that was merely found in the folder was not asked for by name.
pub fn is_unanswered(campaign: &Campaign, results: &Results) -> bool {
    let mut listed = campaign.recordings.iter().filter(|recording| recording.line.is_some());
    results.runs.is_empty() || listed.any(|recording| !has_run(results, &recording.name))
}

fn has_run(results: &Results, recording: &str) -> bool {
    results.runs.iter().any(|run| run.recording == recording)
}
