//! Forced runs whose force has the other sign, where that of other runs has the right one.

use crate::campaign::Campaign;
use crate::diagnosis::cause::Cause;
use crate::inverse::estimate::Estimate;
use crate::inverse::forced::response::SteadyResponse;
use crate::run::{Run, RunKind};

/// The effect that it is an instance of.
const EFFECT: &str = "run.mislabelled";
const EQUATION: &str = "the moment of this run alone has the other sign: M -> s M";

/// A forced run that was refused because its rod takes damping out of the model, and that would
/// have been a run like any other with the other sign.
#[derive(Debug, Clone)]
pub struct Reversed {
    /// Damping by the work per cycle with the other sign [N m s].
    work_damping_n_m_s: Estimate,
}

impl Reversed {
    /// Looks at a run that says nothing as it was recorded; none where its sign is not why.
    pub fn of(run: &Run, campaign: &Campaign) -> Option<Self> {
        if run.kind != RunKind::Forced {
            return None;
        }
        let restoring = campaign.hull.restoring_n_m_per_rad(&campaign.water);
        let response = |run: &Run| SteadyResponse::of(run, restoring, campaign.exciter.as_ref());
        let mut turned = run.clone();
        turned.drive.value.iter_mut().for_each(|value| *value = -*value);
        if let Some(force) = turned.still.as_mut().and_then(|still| still.force.as_mut()) {
            *force = -*force;
        }
        let as_recorded = response(run).is_err();
        let work_damping_n_m_s = response(&turned).ok()?.work_damping_n_m_s;
        as_recorded.then_some(Self { work_damping_n_m_s })
    }

    /// Logarithm of the odds that its damping is as large as it is, against none.
    fn log_odds(&self) -> f64 {
        let Estimate { mean, sd, .. } = self.work_damping_n_m_s;
        0.5 * (mean / sd.max(1e-12)).powi(2)
    }
}

/// The cause that such runs have beside others whose sign is right.
pub(in crate::diagnosis) fn cause(reversed: &[Reversed]) -> Option<Cause> {
    let sign = |_: &Reversed| ("s", "-", Estimate::normal(-1.0, 0.0));
    (!reversed.is_empty()).then(|| Cause {
        effect: EFFECT,
        equation: EQUATION,
        log_bayes_factor: reversed.iter().map(Reversed::log_odds).sum(),
        parameters: reversed.iter().map(sign).collect(),
        equivalent_to: Vec::new(),
    })
}
