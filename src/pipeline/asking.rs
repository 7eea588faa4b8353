//! What an identification must know beside the run, from the campaign and the options.

use std::sync::mpsc::Receiver;

use super::Options;
use super::workers::{Identified, Workers};
use crate::campaign::Campaign;
use crate::inverse::Setting;
use crate::run::{Run, RunKind};

/// Why a forced run is of no use without the arm of its rod.
const NO_ARM: &str = "a rod force was recorded, but the campaign file has no [exciter] with the \
    moment arm that makes a moment of it";

/// Has runs identified, each with a seed of its own.
pub(super) struct Asking<'a> {
    campaign: &'a Campaign,
    options: &'a Options,
    workers: Workers,
    /// Number of the next run, recordings far apart.
    n_runs: u64,
}

impl<'a> Asking<'a> {
    /// For the recording at `index`: its runs' seeds depend on no other recording.
    pub(super) fn new(
        campaign: &'a Campaign,
        options: &'a Options,
        workers: &Workers,
        index: usize,
    ) -> Self {
        Self { campaign, options, workers: workers.clone(), n_runs: (index as u64) << 32 }
    }

    /// Where the answer for a run will arrive.
    pub(super) fn identify(&mut self, run: Run, drive_is_moment: bool) -> Receiver<Identified> {
        let setting = self.setting(run.kind, drive_is_moment);
        self.n_runs += 1;
        match setting {
            Ok(setting) => self.workers.identify(run, setting),
            Err(reason) => Workers::refuse(run, reason),
        }
    }

    /// What the identification of the next run must know.
    ///
    /// # Errors
    /// The reason, as a sentence, why there can be none.
    pub(super) fn setting(
        &self,
        kind: RunKind,
        drive_is_moment: bool,
    ) -> Result<Setting, &'static str> {
        let Campaign { hull, water, exciter, .. } = self.campaign;
        if kind == RunKind::Forced && !drive_is_moment && exciter.is_none() {
            return Err(NO_ARM);
        }
        Ok(Setting {
            restoring_n_m_per_rad: hull.restoring_n_m_per_rad(water),
            exciter: exciter.filter(|_| !drive_is_moment),
            method: self.options.method,
            seed: self.options.seed.wrapping_add(self.n_runs),
        })
    }
}
