//! The run under way as it would be if the recording ended now, and what it says.

use devices::channel::Brought;

use super::collect::Collector;
use super::workers::Identified;
use crate::campaign::Campaign;
use crate::inverse::{self, Setting};
use crate::results::{IdentifiedRun, Overview};
use crate::run::{Run, RunKind};

/// A run that may go on.
pub struct RunSoFar {
    /// The number that it will have in the recording when it has ended.
    pub number: u64,
    pub(super) index: usize,
    pub(super) run: Run,
    pub(super) setting: Setting,
    pub(super) brought: Vec<Brought>,
    pub(super) overview: Overview,
}

impl RunSoFar {
    /// Decay or forced.
    pub fn kind(&self) -> RunKind {
        self.run.kind
    }

    /// First instant that it holds [s].
    pub fn start_s(&self) -> f64 {
        self.run.start_s
    }

    /// What the instruments brought in it, channel by channel.
    pub fn brought(&self) -> &[Brought] {
        &self.brought
    }

    /// Last instant that it holds [s].
    pub fn end_s(&self) -> f64 {
        self.run.end_s
    }

    /// What it says so far, under an id of its own, with its recording so far; none where it says
    /// nothing.
    pub fn identify(self, campaign: &Campaign, id: &str) -> Option<(IdentifiedRun, Overview)> {
        let Self { index, run, setting, brought, overview, .. } = self;
        let identification = inverse::identify(&run, &setting);
        let identified = Identified { run, identification, setting: Some(setting) };
        let mut collector = Collector::new(campaign);
        let run = collector.keep(index, identified, &brought)?;
        id.clone_into(&mut run.id);
        Some((run.clone(), overview))
    }
}
