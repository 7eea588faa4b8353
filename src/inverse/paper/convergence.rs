//! Whether several chains may be believed: split R-hat and effective sample size.
//!
//! Both as in Gelman et al., Bayesian Data Analysis, 3rd ed. (2013), Sec. 11.4-11.5, with the
//! autocorrelations combined over chains and truncated by Geyer's initial monotone sequence, as in
//! Stan and Vehtari et al. (2021), 10.1214/20-BA1221, Sec. 3.1-3.2 (without rank normalisation).

/// What all components of a posterior say together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Largest split R-hat [-].
    pub r_hat_max: f64,
    /// Smallest effective sample size [-].
    pub effective_sample_size_min: f64,
    /// Whether `r_hat_max < 1.05`.
    pub converged: bool,
}

impl Convergence {
    /// Split R-hat from which on the chains are not believed.
    pub const R_HAT_LIMIT: f64 = 1.05;

    /// Judges the worst component.
    pub fn of(r_hat: &[f64], effective_sample_size: &[f64]) -> Self {
        let r_hat_max = r_hat.iter().copied().fold(1.0, f64::max);
        Self {
            r_hat_max,
            effective_sample_size_min: effective_sample_size
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min),
            converged: r_hat_max < Self::R_HAT_LIMIT,
        }
    }
}

/// The draws of one component, each chain cut into halves.
#[derive(Debug, Clone)]
pub struct SplitChains {
    /// Half chains less their means, all of the same length.
    centred: Vec<Vec<f64>>,
    /// Mean over half chains of the variance in them, divisor `n - 1`.
    within: f64,
    /// Estimate of the posterior variance that also holds the spread of the means.
    total: f64,
}

impl SplitChains {
    /// Cuts each path into halves; the middle draw of an odd number is dropped.
    ///
    /// # Panics
    /// When there is no path, one has fewer than 4 draws, or their lengths differ.
    pub fn new(paths: &[Vec<f64>]) -> Self {
        let n_draws = paths.first().expect("at least one chain").len();
        assert!(n_draws >= 4, "at least two draws in each half chain");
        assert!(paths.iter().all(|path| path.len() == n_draws), "chains of one length");
        let n = n_draws / 2;
        let halves = paths.iter().flat_map(|path| [&path[..n], &path[n_draws - n..]]);
        let (means, centred): (Vec<f64>, Vec<Vec<f64>>) = halves
            .map(|half| {
                // Less the first draw, so that a chain that never moved has no spread at all.
                let mean = half[0] + half.iter().map(|x| x - half[0]).sum::<f64>() / n as f64;
                (mean, half.iter().map(|x| x - mean).collect::<Vec<f64>>())
            })
            .unzip();
        let n_halves = centred.len() as f64;
        let squares: f64 = centred.iter().flatten().map(|x| x * x).sum();
        let within = squares / (n_halves * (n as f64 - 1.0));
        let mean = means.iter().sum::<f64>() / n_halves;
        let between = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n_halves - 1.0);
        let total = within * (n as f64 - 1.0) / n as f64 + between;
        Self { centred, within, total }
    }

    /// Split R-hat [-]: 1 when all half chains agree, infinite when none of them moved.
    pub fn r_hat(&self) -> f64 {
        if self.within > 0.0 { (self.total / self.within).sqrt() } else { f64::INFINITY }
    }

    /// Effective sample size [-]: the independent draws that would give the mean as well.
    ///
    /// `N/(-1 + 2 sum P_t)`, where `P_t` are sums of two neighbouring autocorrelations, taken while
    /// positive and made monotone. Zero when no half chain moved.
    pub fn effective_sample_size(&self) -> f64 {
        let n = self.centred[0].len();
        let n_draws = (n * self.centred.len()) as f64;
        if self.within <= 0.0 {
            return 0.0;
        }
        let (mut sum, mut smallest, mut lag) = (0.0, f64::INFINITY, 0);
        while lag + 1 < n {
            let even = self.autocorrelation(lag);
            let pair = even + self.autocorrelation(lag + 1);
            if pair <= 0.0 {
                // The last even term alone, where positive, lessens the bias of the truncation.
                sum += even.max(0.0) / 2.0;
                break;
            }
            smallest = pair.min(smallest);
            sum += smallest;
            lag += 2;
        }
        // Negative autocorrelation may beat independence, but no estimate of it is trusted further.
        let time = (2.0 * sum - 1.0).max(1.0 / n_draws.log10());
        n_draws / time
    }

    /// Autocorrelation at `lag`, combined over the half chains.
    fn autocorrelation(&self, lag: usize) -> f64 {
        if lag == 0 {
            return 1.0;
        }
        let n = self.centred[0].len() as f64;
        let products: f64 = self.centred.iter().map(|x| dot(&x[lag..], x)).sum();
        let autocovariance = products / (n * self.centred.len() as f64);
        1.0 - (self.within - autocovariance) / self.total
    }
}

/// Sum of products over the shorter length, in four lanes so that the processor need not wait.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for lane in 0..4 {
            lanes[lane] += a[lane] * b[lane];
        }
    }
    let rest = n - n % 4;
    let tail: f64 = a[rest..].iter().zip(&b[rest..]).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f64>() + tail
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::*;

    /// Four stationary chains `x' = a x + e` of unit variance.
    fn autoregressive(a: f64, n: usize, seed: u64) -> Vec<Vec<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = move || -> f64 { rng.sample(StandardNormal) };
        (0..4)
            .map(|_| {
                let mut x = normal();
                (0..n)
                    .map(|_| {
                        x = a * x + (1.0 - a * a).sqrt() * normal();
                        x
                    })
                    .collect()
            })
            .collect()
    }

    #[test]
    fn the_effective_sample_size_of_an_autoregression_is_n_one_minus_a_over_one_plus_a() {
        for a in [-0.5, 0.0, 0.5, 0.9, 0.98] {
            let n = 20_000;
            let chains = SplitChains::new(&autoregressive(a, n, 5));
            let expected = 4.0 * n as f64 * (1.0 - a) / (1.0 + a);
            let ratio = chains.effective_sample_size() / expected;
            // Geyer's estimate scatters by a few per cent here; a wrong factor of 2 or a missing
            // term is far outside.
            assert!((ratio - 1.0).abs() < 0.12, "a = {a}: ratio {ratio}");
            assert!(chains.r_hat() < 1.01, "a = {a}: R-hat {}", chains.r_hat());
        }
    }

    #[test]
    fn r_hat_is_the_ratio_of_the_pooled_to_the_inner_spread() {
        let mut chains = autoregressive(0.0, 20_000, 9);
        chains[0].iter_mut().for_each(|x| *x += 2.0);
        // Two of eight half chains shifted by 2: their means have a variance of 6/7 with divisor 7.
        let expected = (1.0_f64 + 6.0 / 7.0).sqrt();
        let split = SplitChains::new(&chains);
        assert!((split.r_hat() - expected).abs() < 0.02, "R-hat {}", split.r_hat());
        assert!(split.effective_sample_size() < 20.0, "chains that disagree know little");
    }

    #[test]
    fn a_drift_shared_by_all_chains_is_seen_because_they_are_split() {
        let mut chains = autoregressive(0.0, 2_000, 9);
        for chain in &mut chains {
            chain.iter_mut().enumerate().for_each(|(i, x)| *x += i as f64 / 1_000.0);
        }
        assert!(SplitChains::new(&chains).r_hat() > 1.05);
    }

    #[test]
    fn chains_that_never_moved_are_not_believed() {
        let stuck = SplitChains::new(&vec![vec![0.3; 100]; 4]);
        assert!(stuck.r_hat().is_infinite());
        assert!(stuck.effective_sample_size().abs() <= 0.0);
        assert!(!Convergence::of(&[1.0, stuck.r_hat()], &[300.0, 0.0]).converged);
    }

    #[test]
    fn a_worked_example_by_hand() {
        // Halves (1,2) (4,3) and (2,2) (3,5): means 1.5 3.5 2 4, variances 0.5 0.5 0 2.
        let split = SplitChains::new(&[vec![1.0, 2.0, 4.0, 3.0], vec![2.0, 2.0, 3.0, 5.0]]);
        let (within, between) = (0.75, 17.0 / 12.0);
        let expected: f64 = (within / 2.0 + between) / within;
        assert!((split.r_hat() - expected.sqrt()).abs() < 1e-12, "R-hat {}", split.r_hat());
    }
}
