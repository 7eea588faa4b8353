//! Keeping what the campaign has taught so far, run by run.

use devices::channel::Brought;

use super::judging::judged;
use super::names;
use super::workers::Identified;
use crate::campaign::Campaign;
use crate::diagnosis;
use crate::inverse;
use crate::inverse::Setting;
use crate::inverse::froude_law::Point;
use crate::inverse::identification::FroudeLaw;
use crate::results::{IdentifiedRun, Overview, RejectedStretch, Results, Sampling};
use crate::run::{Rejection, RunKind};

/// The collecting end of the pipeline.
pub(super) struct Collector<'c> {
    campaign: &'c Campaign,
    labels: Vec<String>,
    /// Runs named so far, by recording.
    n_named: Vec<usize>,
    results: Results,
}

impl<'c> Collector<'c> {
    pub(super) fn new(campaign: &'c Campaign) -> Self {
        let labels = names::labels(&campaign.recordings);
        let n_named = vec![0; labels.len()];
        Self { campaign, labels, n_named, results: Results::default() }
    }

    pub(super) fn n_runs(&self) -> usize {
        self.results.runs.len()
    }

    /// The campaign.
    pub(super) fn campaign(&self) -> &'c Campaign {
        self.campaign
    }

    /// Name of a recording.
    pub(super) fn recording(&self, index: usize) -> &str {
        &self.campaign.recordings[index].name
    }

    /// Keeps a run of a recording with what instruments brought in it; one that could not be
    /// identified becomes a rejection.
    pub(super) fn keep(
        &mut self,
        index: usize,
        identified: Identified,
        brought: &[Brought],
    ) -> Option<&mut IdentifiedRun> {
        let recording = &self.campaign.recordings[index];
        let Identified { run, identification, setting } = identified;
        let mut identification = match identification {
            Ok(identification) => identification,
            Err(reason) => {
                let (start_s, end_s) = (run.start_s, run.end_s);
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
        let mut identified = IdentifiedRun {
            id: format!("{}-{}", self.labels[index], self.n_named[index]),
            recording: recording.name.clone(),
            condition: recording.condition.clone(),
            speed_m_s,
            // The damping of a model towed astern is reported at the size of its speed.
            froude: self.campaign.hull.froude(speed_m_s.abs(), &self.campaign.water),
            sampling: Sampling::of(&run),
            brought: brought.to_vec(),
            run,
            identification,
        };
        if let Some(setting) = setting {
            self.correct(&mut identified, &setting);
        }
        self.results.runs.push(identified);
        self.results.runs.last_mut()
    }

    /// Identifies a run anew without the effects that the campaign's model knows.
    fn correct(&self, identified: &mut IdentifiedRun, setting: &Setting) {
        let Some(model) = &self.campaign.model else { return };
        let Some(corrected) = diagnosis::corrected(identified, self.campaign, model) else {
            return;
        };
        if let Ok(mut again) = inverse::identify(&corrected.run, setting) {
            let effects = corrected.effects.join(", ");
            again.remarks.push(format!("corrected by the campaign's model.toml for {effects}"));
            identified.identification = again;
        }
    }

    pub(super) fn reject(&mut self, index: usize, rejection: Rejection) {
        let Rejection { start_s, end_s, reason } = rejection;
        let recording = self.campaign.recordings[index].name.clone();
        self.results.rejected.push(RejectedStretch {
            recording,
            start_s,
            end_s,
            reason,
            run: None,
        });
    }

    pub(super) fn end_recording(&mut self, overview: Overview) {
        self.results.overviews.push(overview);
    }

    /// What was kept so far, without the laws.
    pub(super) fn so_far(&self) -> &Results {
        &self.results
    }

    pub(super) fn into_results(self) -> Results {
        judged(self.results, &self.campaign.judgements)
    }
}

/// The results of earlier recordings and then of later ones, without the laws.
pub(super) fn joined(earlier: &Results, later: &Results) -> Results {
    let mut all = earlier.clone();
    all.runs.extend_from_slice(&later.runs);
    all.rejected.extend_from_slice(&later.rejected);
    all.overviews.extend_from_slice(&later.overviews);
    all
}

/// One law per condition, in the order in which the conditions were first met.
///
/// Decays carry the law, as in Table 2 of the paper; forced runs only where a condition has none.
pub(super) fn froude_laws(results: &Results) -> Vec<FroudeLaw> {
    let law = |condition: &str| {
        let of_kind = |kind: RunKind| -> Vec<Point> {
            results
                .runs
                .iter()
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
    results.conditions().into_iter().filter_map(law).collect()
}
