//! What a recording and the log say of runs: found, ended, identified or refused.

use devices::clock::Clock;
use replay::{ChannelCounts, ExitStatus, Record, Rejection, RunResult, RunStart, RunStop};

use super::provisional::Told;
use super::reporting::{Identified, Reported};
use super::under_way::UnderWay;
use crate::page::status::ToldBefore;
use crate::pipeline::{Found, FoundRun};
use crate::report::IDENTIFICATION_NAME;
use crate::run::RunKind;

/// Two ends so near to each other are one [s].
const SAME_INSTANT_S: f64 = 1e-3;

impl UnderWay<'_> {
    /// Tells what the run finder has found by the sample that came then.
    pub(super) fn take_found(&mut self, at_ns: u64) {
        let time_s = self.clock.now_ns() as f64 / 1e9;
        for found in std::mem::take(&mut self.state.found) {
            match found {
                Found::Run(run) => {
                    self.state.decided_ns.insert(run.number, at_ns);
                    self.offers.ended(run.number);
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
        let Reported { found, outcome, at_ns, told } = reported;
        let time_s = self.clock.now_ns() as f64 / 1e9;
        let decided_ns = self.state.decided_ns.remove(&found.number).unwrap_or(at_ns);
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
                    run: name_of(&found),
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

/// Name of a run in its recording; results number only those that say something.
fn name_of(found: &FoundRun) -> String {
    format!("found-{}", found.number)
}
