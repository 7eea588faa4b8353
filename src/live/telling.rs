//! What a recording and the log say of runs: found, ended, identified or refused.

use devices::clock::Clock;
use replay::{ChannelCounts, ExitStatus, Record, Rejection, RunResult, RunStart, RunStop};

use super::reporting::Reported;
use super::under_way::UnderWay;
use crate::pipeline::{Found, FoundRun};
use crate::report::IDENTIFICATION_NAME;
use crate::run::RunKind;

impl UnderWay<'_> {
    /// Tells what the run finder has found by the sample that came then.
    pub(super) fn take_found(&mut self, at_ns: u64) {
        let time_s = self.clock.now_ns() as f64 / 1e9;
        for found in std::mem::take(&mut self.state.found) {
            match found {
                Found::Run(run) => {
                    self.state.decided_ns.insert(run.number, at_ns);
                    self.found_run(&run, time_s);
                    self.board.change(|status| {
                        status.runs.n_found += 1;
                        status.motion.run_ended_s = Some(run.end_s);
                    });
                }
                Found::Rejected(rejection) => {
                    let crate::run::Rejection { start_s, end_s, reason } = rejection;
                    tracing::info!(start_s, end_s, "not used: {reason}");
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

    fn found_run(&mut self, found: &FoundRun, time_s: f64) {
        let FoundRun { start_s, end_s, end, ref brought, .. } = *found;
        let run = name_of(found);
        let kind = match found.kind {
            RunKind::Decay => "decay",
            RunKind::Forced => "forced",
        };
        tracing::info!(run, kind, start_s, end_s, "run found");
        let condition = self.campaign.live.condition.clone();
        self.keeper.push(Record::RunStart(RunStart {
            time_s,
            run: run.clone(),
            kind: kind.to_owned(),
            condition,
            start_s,
        }));
        let counts = brought.iter().map(ChannelCounts::of).collect();
        let reason = end.clause().to_owned();
        let exit_status = ExitStatus::Success;
        let stop = RunStop { time_s, run, start_s, end_s, exit_status, reason, counts };
        self.keeper.push(Record::RunStop(stop));
    }

    pub(super) fn reported(&mut self, reported: Reported) {
        let Reported { found, outcome, at_ns } = reported;
        let time_s = self.clock.now_ns() as f64 / 1e9;
        let decided_ns = self.state.decided_ns.remove(&found.number).unwrap_or(at_ns);
        match outcome {
            Ok(identified) => {
                let latency = self.clock.real(at_ns.saturating_sub(decided_ns));
                let latency_s = latency.as_secs_f64();
                let known_after_s = decided_ns as f64 / 1e9 - found.end_s;
                let run = &identified.id;
                tracing::info!(run, latency_s, known_after_s, "{}", identified.summary);
                self.keeper.push(Record::Result(RunResult {
                    time_s,
                    run: name_of(&found),
                    schema: IDENTIFICATION_NAME.to_owned(),
                    document: identified.document,
                }));
                self.board.change(|status| status.runs.reported(latency_s, known_after_s));
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
}

/// Name of a run in its recording; results number only those that say something.
fn name_of(found: &FoundRun) -> String {
    format!("found-{}", found.number)
}
