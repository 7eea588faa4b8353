//! The paper's identifier as printed: its convolution, its posterior, its sampler.
//!
//! Source: Han & Kinoshita, "Stochastic Inverse Identification of Nonlinear Roll Damping Moment of
//! a Ship Moving at Nonzero-Forward Speeds", Mathematical Problems in Engineering 2012,
//! 10.1155/2012/769385; equation, section and figure numbers in this module are its own.
//!
//! The unknown is one moment per sample, `U = -B/(I+dI)` [rad/s2], seen through `g = H U + noise`:
//! - [`convolution`]: `H` and the observable `g`, (2.2)-(2.7);
//! - [`least_squares()`]: the unstable solution that calls for a prior (Fig. 9);
//! - [`settings`]: the hyperpriors of (2.13) and the length of the chains;
//! - [`sample`]: the posterior of (2.13) by single-site Gibbs and Metropolis-Hastings (Sec. 2.4);
//! - [`convergence`]: whether the chains may be believed.

pub mod convergence;
pub mod convolution;
pub mod exact;
pub mod least_squares;
pub mod plain_fit;
pub mod settings;

mod chains;
mod gibbs;
mod kept_draws;
mod log_normal_walk;
mod summary;

use std::ops::ControlFlow;

pub use convolution::Convolution;
pub use least_squares::least_squares;
pub use plain_fit::plain_fit;
pub use settings::{ChainSettings, Hyperpriors, PriorPower};
pub use summary::ChainResult;

/// Draws the posterior (2.13) of the moment history and its two scales, given `g` [rad].
///
/// The result depends on the arguments alone, whatever the number of processors.
///
/// # Errors
/// [`PaperError::NotFinite`], [`PaperError::HyperpriorNotPositive`], [`PaperError::ChainTooShort`].
///
/// # Panics
/// When `g` has not `convolution.n()` entries.
pub fn sample(
    g: &[f64],
    convolution: &Convolution,
    hyper: &Hyperpriors,
    settings: &ChainSettings,
) -> Result<ChainResult, PaperError> {
    sample_watched(g, convolution, hyper, settings, &|_| ControlFlow::Continue(()))
}

/// As [`sample`], telling `watch` from every chain how far it is; a break stops all chains.
///
/// # Errors
/// As [`sample`], and [`PaperError::Interrupted`] when `watch` broke off.
///
/// # Panics
/// When `g` has not `convolution.n()` entries.
pub fn sample_watched(
    g: &[f64],
    convolution: &Convolution,
    hyper: &Hyperpriors,
    settings: &ChainSettings,
    watch: &(dyn Fn(Progress) -> ControlFlow<()> + Sync),
) -> Result<ChainResult, PaperError> {
    assert_eq!(g.len(), convolution.n(), "one observable per sample");
    hyper.check()?;
    settings.check()?;
    if let Some(index) = g.iter().position(|g| !g.is_finite()) {
        return Err(PaperError::NotFinite { index, value: g[index] });
    }
    let problem = gibbs::Problem { g, convolution, hyper, power: settings.prior_power };
    let chains = chains::run(&problem, settings, watch)?;
    Ok(summary::summarise(chains, settings))
}

/// How far one chain is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Which chain, from 0.
    pub chain: usize,
    /// Sweeps done.
    pub sweep: usize,
    /// Sweeps to do, burn-in included.
    pub n_sweeps: usize,
}

/// Why the paper's identifier cannot answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PaperError {
    /// The record is too short for a second difference.
    #[error(
        "the run has {n} samples, the paper's inverse problem needs {n_min}\nhint: use a longer \
         run or a shorter step"
    )]
    TooFewSamples {
        /// Samples given.
        n: usize,
        /// Samples needed.
        n_min: usize,
    },
    /// The step does not resolve the natural frequency, or one of them is not a positive number.
    #[error(
        "step {step_s} s with natural frequency {natural_frequency_rad_s} rad/s: both must be \
         positive and the step below half a natural period, {:.3} s\nhint: decimate less",
        std::f64::consts::PI / natural_frequency_rad_s
    )]
    StepTooLong {
        /// Time between samples [s].
        step_s: f64,
        /// Natural frequency [rad/s].
        natural_frequency_rad_s: f64,
    },
    /// The observable holds something that is not a number.
    #[error(
        "observable g[{index}] is {value}, not a finite number\nhint: cut the run at the gap or \
         fill it"
    )]
    NotFinite {
        /// Sample number.
        index: usize,
        /// What stands there.
        value: f64,
    },
    /// A hyperparameter is not a positive number.
    #[error(
        "hyperparameter {name} is {value}, it must be positive\nhint: the paper uses 0.1 for \
         all four"
    )]
    HyperpriorNotPositive {
        /// Its symbol in (2.13).
        name: &'static str,
        /// Value given.
        value: f64,
    },
    /// Too little is left of the chains after burn-in to judge them.
    #[error(
        "{n_chains} chains of {n_sweeps} sweeps with {n_burn_in} of burn-in: at least one chain \
         and {n_kept_min} sweeps after burn-in are needed\nhint: the paper draws 50000 and drops \
         25000"
    )]
    ChainTooShort {
        /// Number of chains.
        n_chains: usize,
        /// Sweeps of each chain.
        n_sweeps: usize,
        /// Sweeps dropped.
        n_burn_in: usize,
        /// Sweeps needed after burn-in.
        n_kept_min: usize,
    },
    /// The watcher broke off.
    #[error("sampling was interrupted after {sweep} of {n_sweeps} sweeps")]
    Interrupted {
        /// Sweeps done by the chain that stopped first in order of number.
        sweep: usize,
        /// Sweeps asked for.
        n_sweeps: usize,
    },
}
