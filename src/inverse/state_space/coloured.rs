//! Roll noise that remembers: a record under first-order autoregressive noise made white.
//!
//! With noise `e_i = a_i e_(i-1) + ...`, the differences `(y_i - a_i y_(i-1)) / sqrt(1 - a_i^2)`
//! carry white noise of the same variance, so the filter works on them and on a state that starts
//! with the same difference of the roll.

use super::matrix::Matrix;
use super::transition::{Step, Transition};

/// How much of each sample's noise is left of the one before.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    /// The coefficients `a_i` [-]; the first is nil, for nothing is remembered yet.
    coefficients: Vec<f64>,
}

impl Memory {
    /// The memory of a noise whose correlation falls to `1/e` in a scaled time `tau_c` [-].
    pub fn new(tau: &[f64], tau_c: f64) -> Self {
        let later = tau.windows(2).map(|pair| (-(pair[1] - pair[0]) / tau_c).exp());
        Self { coefficients: std::iter::once(0.0).chain(later).collect() }
    }

    /// The differences of a column.
    pub fn differences(&self, column: &[f64]) -> Vec<f64> {
        let before = std::iter::once(&0.0).chain(column);
        let of = |((now, before), a): ((&f64, &f64), &f64)| (now - a * before) * scale(*a);
        column.iter().zip(before).zip(&self.coefficients).map(of).collect()
    }

    /// Logarithm of the density of the record over that of its differences.
    pub fn log_density(&self) -> f64 {
        self.coefficients.iter().map(|a| scale(*a).ln()).sum()
    }

    /// Independent samples that know as much as this record's [-].
    pub fn n_effective(&self) -> f64 {
        self.coefficients.iter().map(|a| (1.0 - a) / (1.0 + a)).sum()
    }
}

fn scale(coefficient: f64) -> f64 {
    (1.0 - coefficient * coefficient).sqrt().recip()
}

/// A prior of `N` components seen through the differences: the difference of the roll comes first,
/// the roll itself last.
pub struct Remembering<'a, T, const N: usize> {
    prior: &'a T,
    memory: &'a Memory,
}

impl<'a, T, const N: usize> Remembering<'a, T, N> {
    /// The prior under noise with this memory.
    pub fn new(prior: &'a T, memory: &'a Memory) -> Self {
        Self { prior, memory }
    }
}

impl<T: Transition<N>, const N: usize, const M: usize> Transition<M> for Remembering<'_, T, N> {
    fn step(&self, to: usize, tau: f64) -> Step<M> {
        const { assert!(M == N + 1, "one component more: the roll before the difference") };
        let inner = self.prior.step(to, tau);
        let a = self.memory.coefficients[to];
        let mut step = Step { f: [[0.0; M]; M], g: [[0.0; M]; M] };
        // Where component j of the prior stands among these.
        let place = |j: usize| if j == 0 { N } else { j };
        for i in 0..N {
            for j in 0..N {
                step.f[place(i)][place(j)] = inner.f[i][j];
                step.g[place(i)][j] = inner.g[i][j];
            }
        }
        for j in 0..N {
            step.f[0][place(j)] = inner.f[0][j] * scale(a);
            step.g[0][j] = inner.g[0][j] * scale(a);
        }
        step.f[0][N] -= a * scale(a);
        step
    }

    fn is_even(&self) -> bool {
        self.prior.is_even()
    }

    fn places(&self) -> [usize; 3] {
        [N, 1, 2]
    }

    fn start(&self) -> Matrix<M> {
        let inner = self.prior.start();
        let mut root = [[0.0; M]; M];
        // The roll is known before the first sample, so its row is nil.
        for i in 1..N {
            root[i][..N].copy_from_slice(&inner[i]);
        }
        root
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_differences_of_a_remembered_noise_are_as_large_as_it_is_and_forget() {
        let tau: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.1).collect();
        let memory = Memory::new(&tau, 0.5);
        // A noise made from a congruential sequence: e_i = a e_(i-1) + sqrt(1 - a^2) n_i.
        let a = (-0.2_f64).exp();
        let mut state = 12_345_u64;
        let mut noise = vec![0.0];
        for _ in 1..4000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let unit = ((state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5) * 12_f64.sqrt();
            noise.push(a * noise[noise.len() - 1] + unit / scale(a));
        }
        let white = memory.differences(&noise);
        let product = |lag: usize| -> f64 {
            white[lag..].iter().zip(&white).map(|(x, y)| x * y).sum::<f64>() / 4000.0
        };
        assert!((product(0) - 1.0).abs() < 0.05, "{}", product(0));
        assert!(product(1).abs() < 0.05, "{}", product(1));
        assert!((memory.n_effective() - 4000.0 * (1.0 - a) / (1.0 + a)).abs() < 2.0);
    }
}
