//! The reporter: writes the page of each run at once, then the campaign's, beside the loop.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use devices::clock::Clock;
use tokio::sync::mpsc::Sender;

use super::diagnosing::{Diagnosed, Diagnoser};
use super::event::Event;
use super::provisional::{Provisional, Told};
use super::showing::show;
use crate::campaign::Campaign;
use crate::diagnosis::Diagnosis;
use crate::inverse::estimate::Estimate;
use crate::page::Board;
use crate::pipeline::{self, FoundRun, Learnt, LiveResults, LiveStep};
use crate::report;
use crate::results::{IdentifiedRun, Results};

/// What became of a run.
pub(super) struct Reported {
    /// As it was found.
    pub(super) found: FoundRun,
    /// What it says, or why it says nothing.
    pub(super) outcome: Result<Identified, String>,
    /// When its page was on disk [ns].
    pub(super) at_ns: u64,
    /// What was told of it before its end was known, in order.
    pub(super) told: Vec<Told>,
}

/// A run that was identified.
pub(super) struct Identified {
    /// Its id in results.
    pub(super) id: String,
    /// Its identification by the JSON contract.
    pub(super) document: String,
    /// One line about it.
    pub(super) summary: String,
    /// Damping at the amplitude at which runs are compared.
    pub(super) damping_per_s: Option<Estimate>,
}

/// Writes reports until the recording has ended.
pub(super) struct Reporter<'a> {
    /// The campaign of this session.
    pub(super) campaign: &'a Campaign,
    /// Where the runs come from.
    pub(super) results: LiveResults<'a>,
    /// What earlier recordings taught, as soon as that is known again.
    pub(super) earlier: Receiver<Option<Results>>,
    /// The daemon's clock.
    pub(super) clock: Arc<dyn Clock>,
    /// What finds out what the simulation gets wrong.
    pub(super) diagnoser: Diagnoser,
    /// What the run under way says, until its final report is there.
    pub(super) provisional: Provisional,
    /// Where results are shown.
    pub(super) board: &'a Board,
    /// The loop.
    pub(super) events: Sender<Event>,
}

impl Reporter<'_> {
    /// Reports each run, and in the end gives all results, earlier ones included and unjudged; none
    /// when those are not known again.
    pub(super) fn run(mut self) -> Option<Results> {
        let dir = pipeline::results_folder(self.campaign);
        let mut known: Option<Results> = None;
        let mut n_reported = 0;
        while let Some(step) = self.results.next_step() {
            let reported = match step {
                LiveStep::Noted => continue,
                LiveStep::TellAgain => {
                    self.diagnoser.ask();
                    None
                }
                LiveStep::Aftermath { recording, aftermath } => {
                    let learnt = Learnt::Aftermath(recording, &aftermath);
                    self.diagnoser.hear(learnt, self.campaign);
                    self.diagnoser.ask();
                    continue;
                }
                LiveStep::Refused { found, reason, reversed } => {
                    if let Some(reversed) = &reversed {
                        self.diagnoser.hear(Learnt::Reversed(reversed), self.campaign);
                        self.diagnoser.ask();
                    }
                    let at_ns = self.clock.now_ns();
                    let told = self.provisional.told_of(&found);
                    Some(Reported { found, outcome: Err(reason), at_ns, told })
                }
                LiveStep::Identified { found, run, overview } => {
                    if let Err(error) =
                        pipeline::write_run_page(self.campaign, run, &overview, &dir)
                    {
                        tracing::error!(run = run.id, "page not written: {error}");
                    }
                    let at_ns = self.clock.now_ns();
                    let told = self.provisional.told_of(&found);
                    let outcome = Ok(identified(self.campaign, run));
                    self.diagnoser.hear(Learnt::Run(run, &overview), self.campaign);
                    self.diagnoser.ask();
                    pipeline::forget_histories(run);
                    Some(Reported { found, outcome, at_ns, told })
                }
            };
            known = known.or_else(|| self.earlier.try_recv().ok().flatten());
            let results = self.shown(known.as_ref(), self.diagnoser.newest().as_ref());
            if let Some(reported) = reported {
                n_reported = reported.found.number;
                // A loop that has ended was told everything before.
                self.events.blocking_send(Event::Reported(Box::new(reported))).ok();
            }
            // Pages of earlier runs would be taken for stale ones before those are known again.
            if known.is_some() {
                write(self.campaign, &results, self.diagnoser.newest().as_deref(), &dir);
                self.provisional.replaced(n_reported);
            }
        }
        self.events.blocking_send(Event::AllReported).ok();
        let Some(earlier) = known.or_else(|| self.earlier.recv().ok().flatten()) else {
            self.provisional.withdraw();
            return None;
        };
        // The next recording does not wait for a diagnosis; only the daemon's end does.
        let diagnosis = self.diagnoser.newest();
        let results = self.shown(Some(&earlier), diagnosis.as_ref());
        write(self.campaign, &results, diagnosis.as_deref(), &dir);
        self.provisional.withdraw();
        Some(self.results.results(&earlier))
    }

    /// Shows all that is known and what nobody has rejected of it; returns that.
    fn shown(&self, earlier: Option<&Results>, diagnosis: Option<&Diagnosed>) -> Results {
        let none = Results::default();
        let found = self.results.results(earlier.unwrap_or(&none));
        show(self.campaign, found, diagnosis, self.board)
    }
}

/// Writes the results of a campaign; what goes wrong is told and ends nothing else.
pub(super) fn write(
    campaign: &Campaign,
    results: &Results,
    diagnosis: Option<&Diagnosis>,
    dir: &Path,
) {
    if let Err(error) = pipeline::write_results(campaign, results, diagnosis, dir) {
        tracing::error!("results not written: {error}");
    }
}

fn identified(campaign: &Campaign, run: &IdentifiedRun) -> Identified {
    let alone = Results { runs: vec![run.clone()], ..Results::default() };
    let b1 = &run.identification.damping.b1_per_s;
    Identified {
        id: run.id.clone(),
        damping_per_s: run.at_comparison().map(|at| at.fitted_per_s),
        document: report::identification_json(campaign, &alone),
        summary: format!(
            "Fr {:.3}, b1 = {:.4} 1/s ({:.4} to {:.4})",
            run.froude, b1.mean, b1.lo95, b1.hi95
        ),
    }
}
