//! A moment that wanders about nil: the stationary Matern prior of order 1 to 3.
//!
//! `(d/dtau + 1)^p u` is a white noise: the moment varies on the time scale of the roll itself and
//! is the smoother the higher its order `p`. Its size follows an envelope, for what a law of
//! damping leaves unexplained dies with the roll.

use super::matrix::Matrix;
use super::transition::{Step, Transition, integrated, oscillator_driven_by};

/// The oscillator under a Matern moment of order `N - 2`.
#[derive(Debug, Clone)]
pub struct Matern<'a, const N: usize> {
    /// Standard deviation of the moment where the envelope is 1, in units of the roll noise [-].
    pub sd: f64,
    /// Envelope of the moment, sample by sample [-].
    pub envelope: &'a [f64],
    /// Steps of a moment of unit standard deviation.
    steps: &'a Steps<N>,
}

/// The distinct steps of a record, for a moment of unit standard deviation.
#[derive(Debug, Clone)]
pub struct Steps<const N: usize> {
    distinct: Vec<Step<N>>,
    place: Vec<u32>,
}

/// Widths are told apart to this fraction of a radian: what a misplaced step does to a moment that
/// is small beside the law's is far below the noise, and the widths of a jittering record are few.
const WIDTH: f64 = 1.0 / 4096.0;

/// The white noise that drives a unit moment of each order: the stationary variance is
/// `(2p-2)!/((p-1)!^2 2^(2p-1))` times its square.
const DRIVE: [f64; 3] = [std::f64::consts::SQRT_2, 2.0, 2.309_401_076_758_503];

impl<const N: usize> Steps<N> {
    /// The steps between the scaled times `tau`.
    pub fn new(tau: &[f64]) -> Self {
        let drift: Matrix<N> = oscillator_driven_by(|a| {
            for i in 2..N - 1 {
                a[i][i + 1] = 1.0;
            }
            // The binomial coefficients of (1 + x)^p, but for the leading one.
            let order = N - 2;
            let mut binomial = 1.0;
            for k in 0..order {
                a[N - 1][2 + k] = -binomial;
                binomial *= (order - k) as f64 / (k + 1) as f64;
            }
        });
        let (mut distinct, mut place) = (Vec::new(), vec![0]);
        let mut widths: Vec<i64> = Vec::new();
        for pair in tau.windows(2) {
            let width = ((pair[1] - pair[0]) / WIDTH).round().max(1.0) as i64;
            let found = widths.iter().position(|known| *known == width);
            let at = found.unwrap_or_else(|| {
                // The first of its kind keeps its own width, so an even record is exact.
                widths.push(width);
                distinct.push(integrated(&drift, pair[1] - pair[0], &[(N - 1, DRIVE[N - 3])]));
                widths.len() - 1
            });
            place.push(at as u32);
        }
        Self { distinct, place }
    }
}

impl<'a, const N: usize> Matern<'a, N> {
    /// The prior of a standard deviation `sd` [-] that follows `envelope` [-].
    pub fn new(sd: f64, envelope: &'a [f64], steps: &'a Steps<N>) -> Self {
        Self { sd, envelope, steps }
    }
}

impl<const N: usize> Transition<N> for Matern<'_, N> {
    fn step(&self, to: usize, _tau: f64) -> Step<N> {
        let mut step = self.steps.distinct[self.steps.place[to] as usize];
        // The state holds the moment over its size, so that only what it does to the roll scales.
        let size = self.sd * 0.5 * (self.envelope[to - 1] + self.envelope[to]);
        for row in 0..2 {
            for moment in 2..N {
                step.f[row][moment] *= size;
            }
            for noise in &mut step.g[row] {
                *noise *= size;
            }
        }
        step
    }

    fn is_even(&self) -> bool {
        false
    }

    fn start(&self) -> Matrix<N> {
        let mut root = [[0.0; N]; N];
        root[2][2] = 1.0;
        match N {
            4 => root[3][3] = 1.0,
            5 => {
                // Stationary covariance [1, 0, -1/3; 0, 1/3, 0; -1/3, 0, 1].
                root[3][3] = (1.0_f64 / 3.0).sqrt();
                root[4][2] = -1.0 / 3.0;
                root[4][4] = (8.0_f64 / 9.0).sqrt();
            }
            _ => {}
        }
        root
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::state_space::matrix::product;

    /// Largest change of the stationary covariance of the moment over one step.
    fn change<const N: usize>() -> f64 {
        let tau = [0.0, 0.7];
        let steps = Steps::<N>::new(&tau);
        let prior = Matern::new(1.0, &[1.0, 1.0], &steps);
        let (root, step) = (prior.start(), prior.step(1, 0.7));
        let moved = product(&step.f, &root);
        let mut worst = 0.0_f64;
        for i in 2..N {
            for j in 2..N {
                let square = |a: &Matrix<N>| (0..N).map(|k| a[i][k] * a[j][k]).sum::<f64>();
                worst = worst.max((square(&moved) + square(&step.g) - square(&root)).abs());
            }
        }
        worst
    }

    #[test]
    fn the_moment_is_as_uncertain_after_a_step_as_before_it() {
        assert!(change::<3>() < 1e-12 && change::<4>() < 1e-12 && change::<5>() < 1e-12);
    }
}
