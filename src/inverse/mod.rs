//! The inverse problem: from a run's record to its damping, with credible bands.

pub mod decay;
pub mod estimate;
pub mod extinction;
pub mod forced;
pub mod froude_law;
pub mod identification;
pub mod mixture;
pub mod paper;
pub mod record;
pub mod scattered;
pub mod state_space;

mod amplitudes;
mod observed;
mod paper_method;
mod plausible;
mod quantum;

use identification::{Identification, Method};

use crate::roll::exciting_moment::Exciter;
use crate::run::{Run, RunKind};

pub use froude_law::froude_law;

/// What an identification needs to know beside the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Restoring coefficient `K = rho g V GM` [N m/rad].
    pub restoring_n_m_per_rad: f64,
    /// How rod force becomes moment; none when the moment itself was recorded.
    pub exciter: Option<Exciter>,
    /// How the moment history is inferred.
    pub method: Method,
    /// Seed of the chains of [`Method::PaperMcmc`].
    pub seed: u64,
}

/// Identifies one run.
///
/// # Errors
/// The reason, as a sentence with its values, why the run cannot be identified.
pub fn identify(run: &Run, setting: &Setting) -> Result<Identification, String> {
    plausible::roll(run)?;
    match run.kind {
        RunKind::Decay => decay::identify(run, setting),
        RunKind::Forced => forced::identify(run, setting),
    }
}
