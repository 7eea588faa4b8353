//! Gathering the runs of a campaign for the diagnosis while they are identified.

use crate::campaign::Campaign;
use crate::diagnosis::{self, Diagnosis, Observation};
use crate::results::IdentifiedRun;

/// What the diagnosis will see of the runs heard so far.
pub struct Observed<'c> {
    campaign: &'c Campaign,
    observations: Vec<Observation>,
    left_out: Vec<String>,
}

impl<'c> Observed<'c> {
    /// Nothing yet.
    pub fn new(campaign: &'c Campaign) -> Self {
        Self { campaign, observations: Vec::new(), left_out: Vec::new() }
    }

    /// Takes a run whose histories are still with it.
    pub fn hear(&mut self, run: &IdentifiedRun) {
        match Observation::new(run, self.campaign, self.observations.len()) {
            Ok(observation) => self.observations.push(observation),
            Err(reason) => self.left_out.push(format!("{}: {reason}", run.id)),
        }
    }

    /// The runs that take no part, each with its reason.
    pub fn left_out(&self) -> &[String] {
        &self.left_out
    }

    /// What the runs say; none without runs.
    pub fn diagnosed(self) -> Option<Diagnosis> {
        diagnosis::diagnose(self.observations, &self.campaign.tank)
    }
}
