//! What the sampler is told beside the record: hyperpriors, chain lengths, seed.

use super::PaperError;

/// The gamma and inverse-gamma hyperpriors of (2.13), in its own parametrisation.
///
/// `p(lambda) ~ lambda^(alpha1-1) exp(-lambda beta1/2)` and
/// `p(sigma^2) ~ (sigma^2)^-(alpha2+1) exp(-beta2/sigma^2)`: the second is a density of `sigma^2`,
/// as its exponent says, though the text calls it the prior of `sigma`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hyperpriors {
    /// Shape of the prior of `lambda` [-].
    pub alpha1: f64,
    /// Twice the rate of the prior of `lambda` [rad2/s4].
    pub beta1: f64,
    /// Shape of the prior of `sigma^2` [-].
    pub alpha2: f64,
    /// Scale of the prior of `sigma^2` [rad2].
    pub beta2: f64,
}

impl Hyperpriors {
    /// The values of Sec. 4.1, not scale free: `beta2` alone asks for a noise of 0.3 rad or so.
    pub const PAPER: Self = Self { alpha1: 0.1, beta1: 0.1, alpha2: 0.1, beta2: 0.1 };

    /// Refuses values for which (2.13) is no density.
    pub(super) fn check(&self) -> Result<(), PaperError> {
        let named = [
            ("alpha1", self.alpha1),
            ("beta1", self.beta1),
            ("alpha2", self.alpha2),
            ("beta2", self.beta2),
        ];
        match named.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((name, value)) => Err(PaperError::HyperpriorNotPositive { name, value }),
            None => Ok(()),
        }
    }
}

/// The power of `lambda` that normalises the random-walk prior (2.10).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PriorPower {
    /// `lambda^(n/2)`, as printed.
    Printed,
    /// `lambda^((n-1)/2)`: `W` has rank `n - 1`, for it leaves a constant moment free.
    Rank,
}

impl PriorPower {
    /// The exponent for `n` moments.
    pub fn exponent(self, n: usize) -> f64 {
        match self {
            Self::Printed => n as f64 / 2.0,
            Self::Rank => (n as f64 - 1.0) / 2.0,
        }
    }
}

/// How long the chains are, and what makes them repeat.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChainSettings {
    /// Sweeps of each chain, burn-in included.
    pub n_sweeps: usize,
    /// Sweeps dropped from the front of each chain; the proposals adapt in these only.
    pub n_burn_in: usize,
    /// Number of chains, each from the paper's start with its own random stream.
    pub n_chains: usize,
    /// Seed of all chains.
    pub seed: u64,
    /// Power of `lambda` in the prior.
    pub prior_power: PriorPower,
}

impl ChainSettings {
    /// Sweeps after burn-in below which half chains say nothing.
    const N_KEPT_MIN: usize = 100;

    /// Sec. 4.1: 50 000 sweeps, half of them burn-in, prior as printed; four chains, so that they
    /// can be compared.
    pub fn paper(seed: u64) -> Self {
        Self {
            n_sweeps: 50_000,
            n_burn_in: 25_000,
            n_chains: 4,
            seed,
            prior_power: PriorPower::Printed,
        }
    }

    /// Refuses chains that nothing could be learnt from.
    pub(super) fn check(&self) -> Result<(), PaperError> {
        if self.n_chains > 0 && self.n_sweeps >= self.n_burn_in.saturating_add(Self::N_KEPT_MIN) {
            return Ok(());
        }
        Err(PaperError::ChainTooShort {
            n_chains: self.n_chains,
            n_sweeps: self.n_sweeps,
            n_burn_in: self.n_burn_in,
            n_kept_min: Self::N_KEPT_MIN,
        })
    }
}
