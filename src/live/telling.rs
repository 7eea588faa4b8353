//! What a recording and the log say of runs: found, ended, identified or refused.

use devices::clock::Clock;
use replay::{ChannelCounts, ExitStatus, Record, Rejection, RunResult, RunStart, RunStop};

use super::provisional::Told;
use super::reporting::{Identified, Reported};
use super::under_way::UnderWay;
use crate::page::status::ToldBefore;
use crate::pipeline::{Found, FoundRun, RunSoFar};
use crate::report::IDENTIFICATION_NAME;
use crate::run::{RunEnd, RunKind};

/// Two ends so near to each other are one [s].
const SAME_INSTANT_S: f64 = 1e-3;

/// A run that began, and may go on or turn out to be none.
#[derive(Debug, Clone)]
pub(super) struct Begun {
    /// Its name in the recording.
    name: String,
    kind: RunKind,
    start_s: f64,
    end_s: f64,
    counts: Vec<ChannelCounts>,
}

/// A run whose end is known.
#[derive(Debug)]
pub(super) struct Decided {
    /// Its name in the recording.
    name: String,
    /// When the sample came by which it was known [ns].
    at_ns: u64,
}

impl Begun {
    /// The run under way.
    pub(super) fn of(run: &RunSoFar) -> Self {
        let (name, counts) = (String::new(), run.brought().iter().map(ChannelCounts::of).collect());
        Self { name, kind: run.kind(), start_s: run.start_s(), end_s: run.end_s(), counts }
    }

    fn of_found(found: &FoundRun) -> Self {
        let FoundRun { kind, start_s, end_s, ref brought, .. } = *found;
        let counts = brought.iter().map(ChannelCounts::of).collect();
        Self { name: String::new(), kind, start_s, end_s, counts }
    }

    fn has_part_in(&self, start_s: f64, end_s: f64) -> bool {
        self.start_s < end_s && start_s < self.end_s
    }

    fn stop(self, time_s: f64, exit_status: ExitStatus, reason: &str) -> Record {
        let Self { name: run, start_s, end_s, counts, .. } = self;
        let reason = reason.to_owned();
        Record::RunStop(RunStop { time_s, run, start_s, end_s, exit_status, reason, counts })
    }
}

impl UnderWay<'_> {
    /// Takes the run that is under way now, or that there is none.
    pub(super) fn take_so_far(&mut self, now: Option<Begun>) {
        match (now, self.state.begun.take()) {
            (Some(now), Some(before)) => {
                self.state.begun = Some(Begun { end_s: now.end_s, counts: now.counts, ..before });
            }
            (Some(now), None) => self.state.begun = Some(self.begin(now)),
            (None, Some(before)) => self.stop(before, ExitStatus::Fail, "it became no run"),
            (None, None) => {}
        }
    }

    /// The recording has ended: so has a run that nobody found the end of.
    pub(super) fn break_off(&mut self) {
        if let Some(begun) = self.state.begun.take() {
            self.stop(begun, ExitStatus::Abort, "the recording ended");
        }
    }

    fn begin(&mut self, begun: Begun) -> Begun {
        self.state.n_begun += 1;
        let begun = Begun { name: format!("run-{}", self.state.n_begun), ..begun };
        self.keeper.push(Record::RunStart(RunStart {
            time_s: self.now_s(),
            run: begun.name.clone(),
            kind: begun.kind.name().to_owned(),
            condition: self.campaign.live.condition.clone(),
            start_s: begun.start_s,
        }));
        begun
    }

    fn stop(&mut self, begun: Begun, exit_status: ExitStatus, reason: &str) {
        self.keeper.push(begun.stop(self.now_s(), exit_status, reason));
    }

    fn now_s(&self) -> f64 {
        self.clock.now_ns() as f64 / 1e9
    }

    /// Tells what the run finder has found by the sample that came then.
    pub(super) fn take_found(&mut self, at_ns: u64) {
        let time_s = self.clock.now_ns() as f64 / 1e9;
        for found in std::mem::take(&mut self.state.found) {
            match found {
                Found::Run(run) => {
                    self.offers.ended(run.number);
                    let name = self.found_run(&run);
                    self.state.decided.insert(run.number, Decided { name, at_ns });
                    self.board.change(|status| {
                        status.runs.n_found += 1;
                        status.motion.run_ended_s = Some(run.end_s);
                    });
                }
                Found::Rejected(rejection) => {
                    let crate::run::Rejection { start_s, end_s, reason } = rejection;
                    tracing::info!(start_s, end_s, "not used: {reason}");
                    let of_it = |begun: &mut Begun| begun.has_part_in(start_s, end_s);
                    if let Some(begun) = self.state.begun.take_if(of_it) {
                        self.stop(begun, ExitStatus::Fail, &reason);
                    }
                    self.keeper.push(Record::Rejection(Rejection {
                        time_s,
                        start_s,
                        end_s,
                        reason,
                    }));
                    self.board.change(|status| status.runs.n_rejected += 1);
                }
            }
        }
    }

    /// The name of a run that was found; one that nobody saw begin begins with its end.
    fn found_run(&mut self, found: &FoundRun) -> String {
        let FoundRun { start_s, end_s, .. } = *found;
        let begun = match self.state.begun.take() {
            Some(begun) if begun.has_part_in(start_s, end_s) => begun,
            other => {
                if let Some(other) = other {
                    self.stop(other, ExitStatus::Fail, "it became no run");
                }
                self.begin(Begun::of_found(found))
            }
        };
        let run = &begun.name;
        tracing::info!(run, kind = found.kind.name(), start_s, end_s, "run found");
        begun.name
    }

    pub(super) fn reported(&mut self, reported: Reported) {
        let Reported { found, outcome, at_ns, told } = reported;
        let time_s = self.clock.now_ns() as f64 / 1e9;
        let Some(Decided { name, at_ns: decided_ns }) = self.state.decided.remove(&found.number)
        else {
            return;
        };
        let stopped = Begun { name: name.clone(), ..Begun::of_found(&found) };
        let (exit_status, reason) = match &outcome {
            Ok(_) => (exit_status(found.end), found.end.clause()),
            Err(reason) => (ExitStatus::Fail, reason.as_str()),
        };
        self.stop(stopped, exit_status, reason);
        match outcome {
            Ok(identified) => {
                let latency = self.clock.real(at_ns.saturating_sub(decided_ns));
                let latency_s = latency.as_secs_f64();
                let known_after_s = decided_ns as f64 / 1e9 - found.end_s;
                let final_s = latency_s + known_after_s;
                let before = self.told_before(&found, &identified, &told, final_s);
                let first_after_s = before.first_after_s;
                let run = &identified.id;
                let summary = &identified.summary;
                tracing::info!(run, latency_s, known_after_s, first_after_s, "{summary}");
                self.keeper.push(Record::Result(RunResult {
                    time_s,
                    run: name,
                    schema: IDENTIFICATION_NAME.to_owned(),
                    document: identified.document,
                }));
                self.board.change(|status| status.runs.reported(latency_s, known_after_s, before));
            }
            Err(reason) => {
                let (start_s, end_s) = (found.start_s, found.end_s);
                tracing::warn!(start_s, end_s, "run refused: {reason}");
                let rejection = Rejection { time_s, start_s, end_s, reason };
                self.keeper.push(Record::Rejection(rejection));
                self.board.change(|status| status.runs.n_refused += 1);
            }
        }
    }

    /// The provisional reports of a run seen from its final one, which came `final_s` after its
    /// last sample.
    fn told_before(
        &self,
        found: &FoundRun,
        identified: &Identified,
        told: &[Told],
        final_s: f64,
    ) -> ToldBefore {
        let later_s = |told: &Told| told.end_s - found.end_s;
        let moved_sd = |told: &Told| {
            let (last, then) = (identified.damping_per_s?, told.damping_per_s?);
            Some((last.mean - then.mean) / last.sd)
        };
        // The clock's line may move a stamp a little, never by a sample.
        let first = told.iter().find(|told| later_s(told) > -SAME_INSTANT_S);
        let after_s = |told: &Told| {
            let took = self.clock.real(told.at_ns.saturating_sub(told.offered_ns));
            told.offered_ns as f64 / 1e9 - found.end_s + took.as_secs_f64()
        };
        ToldBefore {
            first_after_s: first.map_or(final_s, after_s).min(final_s),
            first_ends_later_s: first.map(later_s),
            first_moved_sd: first.and_then(moved_sd),
            last_ends_later_s: told.last().map(later_s),
            last_moved_sd: told.last().and_then(moved_sd),
        }
    }
}

/// How a run ended whose report is there.
fn exit_status(end: RunEnd) -> ExitStatus {
    match end {
        RunEnd::Gap | RunEnd::RecordingEnded | RunEnd::TooLong => ExitStatus::Abort,
        RunEnd::LostInNoise
        | RunEnd::Caught
        | RunEnd::PassEnded
        | RunEnd::ReStruck
        | RunEnd::ExcitationChanged => ExitStatus::Success,
    }
}
