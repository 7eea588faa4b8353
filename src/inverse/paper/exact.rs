//! The posterior (2.13) without a chain, for comparison with the sampler.

use super::{Convolution, Hyperpriors, PriorPower};
use crate::inverse::state_space::posterior::{
    Hyperprior, MomentProblem, Quadrature, StatePosterior,
};
use crate::inverse::state_space::transition::PaperWalk;

/// Exact mean and standard deviation of the paper's moment history.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactPosterior {
    /// Mean of each `U` [rad/s2].
    pub mean: Vec<f64>,
    /// Standard deviation of each `U` [rad/s2].
    pub sd: Vec<f64>,
    /// Root mean square of the noise `sigma` [rad].
    pub sigma_rad: f64,
}

/// Solves (2.13) for `g` [rad] in time proportional to its length.
pub fn exact(
    g: &[f64],
    convolution: &Convolution,
    hyper: &Hyperpriors,
    power: PriorPower,
    quadrature: Quadrature,
) -> ExactPosterior {
    let w = convolution.natural_frequency_rad_s();
    let step = w * convolution.step_s();
    let tau: Vec<f64> = (0..g.len()).map(|i| step * i as f64).collect();
    let states: StatePosterior = MomentProblem {
        tau: &tau,
        record: g,
        free_components: &[2],
        prior: |difference: f64| PaperWalk { difference },
        hyperprior: Hyperprior::Conjugate { hyper: *hyper, power, natural_frequency_rad_s: w },
        quadrature,
    }
    .solve::<3, _>();
    ExactPosterior {
        mean: states.mean.iter().map(|m| w * w * m[2]).collect(),
        sd: states.sd.iter().map(|s| w * w * s[2]).collect(),
        sigma_rad: states.noise_sd_rad,
    }
}
