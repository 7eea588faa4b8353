//! Identifying runs one after the other and keeping what the campaign has taught so far.

use super::{Options, names};
use crate::campaign::Campaign;
use crate::inverse::froude_law::Point;
use crate::inverse::identification::FroudeLaw;
use crate::inverse::{self, Setting};
use crate::results::{IdentifiedRun, Overview, RejectedStretch, Results};
use crate::run::{Rejection, Run, RunKind};

/// Why a forced run is of no use without the arm of its rod.
const NO_ARM: &str = "a rod force was recorded, but the campaign file has no [exciter] with the \
    moment arm that makes a moment of it";

/// The identifying end of the pipeline.
pub(super) struct Identifier<'c> {
    campaign: &'c Campaign,
    options: &'c Options,
    labels: Vec<String>,
    /// Runs named so far, by recording.
    n_named: Vec<usize>,
    /// Runs found so far, so that each has its own stream of randomness.
    n_found: u64,
    results: Results,
}

impl<'c> Identifier<'c> {
    pub(super) fn new(campaign: &'c Campaign, options: &'c Options) -> Self {
        let labels = names::labels(&campaign.recordings);
        let n_named = vec![0; labels.len()];
        Self { campaign, options, labels, n_named, n_found: 0, results: Results::default() }
    }

    pub(super) fn n_runs(&self) -> usize {
        self.results.runs.len()
    }

    /// Identifies a run of a recording; one that cannot be identified becomes a rejection.
    pub(super) fn identify(
        &mut self,
        index: usize,
        run: Run,
        drive_is_moment: bool,
    ) -> Option<&mut IdentifiedRun> {
        let recording = &self.campaign.recordings[index];
        let setting = Setting {
            restoring_n_m_per_rad: self.campaign.hull.restoring_n_m_per_rad(&self.campaign.water),
            exciter: self.campaign.exciter.filter(|_| !drive_is_moment),
            method: self.options.method,
            seed: self.options.seed.wrapping_add(self.n_found),
        };
        self.n_found += 1;
        let identified =
            if run.kind == RunKind::Forced && !drive_is_moment && setting.exciter.is_none() {
                Err(NO_ARM.to_owned())
            } else {
                inverse::identify(&run, &setting)
            };
        let mut identification = match identified {
            Ok(identification) => identification,
            Err(reason) => {
                let Run { start_s, end_s, .. } = run;
                self.reject(index, Rejection { start_s, end_s, reason });
                return None;
            }
        };
        let speed_m_s = run.speed_m_s.or(recording.speed_m_s).unwrap_or_else(|| {
            let remark = "no carriage speed was recorded or declared; taken as at rest";
            identification.remarks.push(remark.to_owned());
            0.0
        });
        self.n_named[index] += 1;
        self.results.runs.push(IdentifiedRun {
            id: format!("{}-{}", self.labels[index], self.n_named[index]),
            recording: recording.name.clone(),
            condition: recording.condition.clone(),
            speed_m_s,
            // The damping of a model towed astern is reported at the size of its speed.
            froude: self.campaign.hull.froude(speed_m_s.abs(), &self.campaign.water),
            run,
            identification,
        });
        self.results.runs.last_mut()
    }

    pub(super) fn reject(&mut self, index: usize, rejection: Rejection) {
        let Rejection { start_s, end_s, reason } = rejection;
        let recording = self.campaign.recordings[index].name.clone();
        self.results.rejected.push(RejectedStretch { recording, start_s, end_s, reason });
    }

    pub(super) fn end_recording(&mut self, overview: Overview) {
        self.results.overviews.push(overview);
    }

    pub(super) fn into_results(mut self) -> Results {
        self.results.froude_laws = froude_laws(&self.results.runs);
        self.results
    }
}

/// One law per condition, in the order in which the conditions were first met.
///
/// Decays carry the law, as in Table 2 of the paper; forced runs only where a condition has none.
fn froude_laws(runs: &[IdentifiedRun]) -> Vec<FroudeLaw> {
    let mut conditions: Vec<&str> = Vec::new();
    for run in runs {
        if !conditions.contains(&run.condition.as_str()) {
            conditions.push(&run.condition);
        }
    }
    let law = |condition: &str| {
        let of_kind = |kind: RunKind| -> Vec<Point> {
            runs.iter()
                .filter(|run| run.condition == condition && run.run.kind == kind)
                .map(|run| {
                    let damping = &run.identification.damping;
                    Point { froude: run.froude, b1_per_s: damping.b1_per_s, b3_s: damping.b3_s }
                })
                .collect()
        };
        let decays = of_kind(RunKind::Decay);
        let points = if decays.is_empty() { of_kind(RunKind::Forced) } else { decays };
        inverse::froude_law(condition, &points)
    };
    conditions.into_iter().filter_map(law).collect()
}
