//! Finished chains as posterior means, bands and a verdict on convergence.

use super::chains::FinishedChain;
use super::convergence::{Convergence, SplitChains};
use super::settings::ChainSettings;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::Chain;

/// The posterior as drawn; vectors have one entry per sample.
///
/// Means and standard deviations are over every sweep after burn-in. Bands, R-hat and effective
/// sample size come from the kept draws, every k-th sweep; k is 1 for short chains and otherwise
/// such that 32 MiB and 5 000 draws a chain suffice. The effective sample size is therefore at most
/// the number of kept draws, hence on the safe side.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainResult {
    /// Posterior mean of `U = -B/(I+dI)` [rad/s2].
    pub mean: Vec<f64>,
    /// Posterior standard deviation of `U` [rad/s2].
    pub sd: Vec<f64>,
    /// Lower end of the central 95 % interval of `U` [rad/s2].
    pub lo95: Vec<f64>,
    /// Upper end of the central 95 % interval of `U` [rad/s2].
    pub hi95: Vec<f64>,
    /// Precision `lambda` of the prior [s4].
    pub lambda: Estimate,
    /// Roll noise `sigma` [rad].
    pub sigma: Estimate,
    /// Split R-hat of each `U` [-].
    pub r_hat: Vec<f64>,
    /// Effective sample size of each `U` [-].
    pub effective_sample_size: Vec<f64>,
    /// Split R-hat of `lambda` and of `sigma` [-].
    pub scale_r_hat: [f64; 2],
    /// Effective sample size of `lambda` and of `sigma` [-].
    pub scale_effective_sample_size: [f64; 2],
    /// What the chains say about themselves, `lambda` and `sigma` included, with the traces of the
    /// first of them.
    pub chain: Chain,
}

/// One component over all chains.
struct Component {
    estimate: Estimate,
    r_hat: f64,
    effective_sample_size: f64,
}

impl Component {
    fn of(chains: &[FinishedChain], component: usize) -> Self {
        let moments = chains
            .iter()
            .map(|chain| chain.kept.moments(component))
            .reduce(super::kept_draws::Moments::merged)
            .expect("the settings demand a chain");
        let paths: Vec<Vec<f64>> = chains.iter().map(|chain| chain.kept.path(component)).collect();
        let split = SplitChains::new(&paths);
        let mut pooled = paths.concat();
        let estimate = Estimate {
            mean: moments.mean(),
            sd: moments.sd(),
            lo95: quantile(&mut pooled, 0.025),
            hi95: quantile(&mut pooled, 0.975),
        };
        Self {
            estimate,
            r_hat: split.r_hat(),
            effective_sample_size: split.effective_sample_size(),
        }
    }
}

/// Brings the chains of one posterior together.
pub(super) fn summarise(mut chains: Vec<FinishedChain>, settings: &ChainSettings) -> ChainResult {
    let n_components = chains[0].kept.n_components();
    let mut components: Vec<Component> =
        (0..n_components).map(|component| Component::of(&chains, component)).collect();
    let r_hat: Vec<f64> = components.iter().map(|c| c.r_hat).collect();
    let sizes: Vec<f64> = components.iter().map(|c| c.effective_sample_size).collect();
    let Convergence { r_hat_max, effective_sample_size_min, converged } =
        Convergence::of(&r_hat, &sizes);
    let chain = Chain {
        seed: settings.seed,
        n_sweeps: settings.n_sweeps,
        n_burn_in: settings.n_burn_in,
        n_chains: settings.n_chains,
        r_hat_max,
        effective_sample_size_min,
        converged,
        traces: std::mem::take(&mut chains[0].traces),
    };
    let scales = components.split_off(n_components - 2);
    let of = |value: fn(&Component) -> f64| components.iter().map(value).collect::<Vec<f64>>();
    ChainResult {
        mean: of(|c| c.estimate.mean),
        sd: of(|c| c.estimate.sd),
        lo95: of(|c| c.estimate.lo95),
        hi95: of(|c| c.estimate.hi95),
        lambda: scales[0].estimate,
        sigma: scales[1].estimate,
        r_hat: of(|c| c.r_hat),
        effective_sample_size: of(|c| c.effective_sample_size),
        scale_r_hat: [scales[0].r_hat, scales[1].r_hat],
        scale_effective_sample_size: [
            scales[0].effective_sample_size,
            scales[1].effective_sample_size,
        ],
        chain,
    }
}

/// Quantile by linear interpolation between order statistics; reorders `draws`.
fn quantile(draws: &mut [f64], probability: f64) -> f64 {
    let place = probability * (draws.len() - 1) as f64;
    let below = place.floor() as usize;
    let (_, &mut low, above) = draws.select_nth_unstable_by(below, f64::total_cmp);
    let high = above.iter().copied().fold(f64::INFINITY, f64::min);
    if high.is_finite() { low + (place - below as f64) * (high - low) } else { low }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_order_statistics() {
        let mut draws: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        assert!((quantile(&mut draws, 0.025) - 2.5).abs() < 1e-12);
        assert!((quantile(&mut draws, 0.975) - 97.5).abs() < 1e-12);
        assert!((quantile(&mut draws, 1.0) - 100.0).abs() < 1e-12);
    }
}
