//! What is kept of a chain: running moments of every sweep, and evenly spaced draws in bounded
//! memory.

/// Running mean and variance of one quantity (Welford's recurrence).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Moments {
    n: usize,
    mean: f64,
    squares: f64,
}

impl Moments {
    /// Takes one more value.
    pub(super) fn push(&mut self, value: f64) {
        self.n += 1;
        let deviation = value - self.mean;
        self.mean += deviation / self.n as f64;
        self.squares += deviation * (value - self.mean);
    }

    /// The moments of both sets of values together.
    pub(super) fn merged(self, other: Self) -> Self {
        let n = self.n + other.n;
        if n == 0 {
            return self;
        }
        let share = other.n as f64 / n as f64;
        let apart = other.mean - self.mean;
        Self {
            n,
            mean: self.mean + share * apart,
            squares: self.squares + other.squares + apart * apart * share * self.n as f64,
        }
    }

    /// Mean.
    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation.
    pub(super) fn sd(&self) -> f64 {
        (self.squares / (self.n.max(2) - 1) as f64).sqrt()
    }
}

/// The sweeps of one chain after burn-in; a sweep is `U`, then `lambda`, then `sigma`.
#[derive(Debug, Clone)]
pub(super) struct KeptDraws {
    moments: Vec<Moments>,
    /// Draw after draw, every `spacing`-th sweep.
    draws: Vec<f64>,
    spacing: usize,
    n_seen: usize,
}

impl KeptDraws {
    /// Numbers kept over all chains: 32 MiB, so that a run of 500 samples and four chains keeps
    /// 2 000 draws of each.
    const N_NUMBERS_MAX: usize = 4 << 20;
    /// Draws kept of a chain at most; more would not sharpen a 2.5 % quantile that anyone can see.
    const N_DRAWS_MAX: usize = 5_000;
    /// Draws kept of a chain at least, however long the run, so that split R-hat means something.
    const N_DRAWS_MIN: usize = 100;

    /// Room for one of `n_chains` chains of `n_components` over `n_sweeps` sweeps after burn-in.
    pub(super) fn new(n_components: usize, n_sweeps: usize, n_chains: usize) -> Self {
        let affordable = Self::N_NUMBERS_MAX / (n_components * n_chains);
        let n_draws_max = affordable.clamp(Self::N_DRAWS_MIN, Self::N_DRAWS_MAX);
        let spacing = n_sweeps.div_ceil(n_draws_max);
        Self {
            moments: vec![Moments::default(); n_components],
            draws: Vec::with_capacity(n_sweeps / spacing * n_components),
            spacing,
            n_seen: 0,
        }
    }

    /// Takes one sweep.
    pub(super) fn push(&mut self, sweep: impl Iterator<Item = f64>) {
        self.n_seen += 1;
        let keep = self.n_seen.is_multiple_of(self.spacing);
        for (moments, value) in self.moments.iter_mut().zip(sweep) {
            moments.push(value);
            if keep {
                self.draws.push(value);
            }
        }
    }

    /// Number of components.
    pub(super) fn n_components(&self) -> usize {
        self.moments.len()
    }

    /// Moments of one component over every sweep.
    pub(super) fn moments(&self, component: usize) -> Moments {
        self.moments[component]
    }

    /// Kept draws of one component, in order.
    pub(super) fn path(&self, component: usize) -> Vec<f64> {
        self.draws.iter().skip(component).step_by(self.moments.len()).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_merge_into_the_moments_of_all_their_sweeps() {
        let values: Vec<f64> = (0..50).map(|i| 1e3 + (f64::from(i) * 0.7).sin()).collect();
        let of = |values: &[f64]| {
            let mut moments = Moments::default();
            for value in values {
                moments.push(*value);
            }
            moments
        };
        let merged = of(&values[..13]).merged(of(&values[13..]));
        let mean = values.iter().sum::<f64>() / 50.0;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 49.0;
        // Rounding of values of size 1e3.
        assert!((merged.mean() - mean).abs() < 1e-11);
        assert!((merged.sd() - variance.sqrt()).abs() < 1e-11);
    }

    #[test]
    fn the_kept_draws_are_evenly_spaced() {
        let mut kept = KeptDraws::new(3, 25_000, 4);
        for sweep in 0..25_000 {
            kept.push([f64::from(sweep), 0.0, -f64::from(sweep)].into_iter());
        }
        let path = kept.path(2);
        assert_eq!(path.len(), KeptDraws::N_DRAWS_MAX);
        assert!(path.windows(2).all(|pair| (pair[0] - pair[1] - 5.0).abs() < 1e-12));
        // Every sweep counts in the mean, kept or not.
        assert!((kept.moments(0).mean() - 12_499.5).abs() < 1e-8);
    }

    #[test]
    fn memory_does_not_grow_with_the_length_of_the_chains() {
        for n_sweeps in [25_000, 2_500_000] {
            let kept = KeptDraws::new(502, n_sweeps, 4);
            assert!(kept.draws.capacity() * 4 <= KeptDraws::N_NUMBERS_MAX, "{n_sweeps} sweeps");
        }
    }
}
