//! How roll and unknown moment move together from one sample to the next.
//!
//! Time is scaled by the natural frequency, `tau = w t`, so that the linear oscillator of (2.1) per
//! unit inertia reads `y'' + y = u` and every state is in radians: roll `y`, rate `y' = phi'/w`,
//! moment `u = U/w^2`, then the derivatives of `u`. Nothing below depends on units.

use super::matrix::{Matrix, exponential, triangular_root};

/// One step `x -> F x + G w` with `w` standard normal; the noise of the roll channel is the unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<const N: usize> {
    /// How the state moves on its own.
    pub f: Matrix<N>,
    /// Lower triangular root of the covariance of what is added.
    pub g: Matrix<N>,
}

/// A prior of the unknown moment, as the motion of an `N`-component state.
pub trait Transition<const N: usize> {
    /// The step over a scaled time `tau` [-] that leads to sample number `to`.
    fn step(&self, to: usize, tau: f64) -> Step<N>;

    /// Whether steps of one width are alike, so that gains that have settled can be kept.
    fn is_even(&self) -> bool {
        true
    }

    /// Triangular root of what is not known of the state before the first sample.
    fn start(&self) -> Matrix<N> {
        [[0.0; N]; N]
    }

    /// Where roll, rate and moment stand in the state.
    fn places(&self) -> [usize; 3] {
        [0, 1, 2]
    }
}

/// The moment's `N - 2`-th derivative is a white noise: a random walk, its integral, and so on.
///
/// A continuous-time prior, so unequal steps and gaps need no resampling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegratedWiener {
    /// Intensity of the white noise, in units of the roll noise [-].
    pub intensity: f64,
    /// Intensity of a white noise in the moment itself, such as that of a measured moment [-].
    pub moment_noise: f64,
}

/// Nodes and weights of Gauss-Legendre quadrature on `[0, 1]`, exact to degree 15: the covariance
/// of a step is a polynomial of degree 9 in the step for the highest order, and nearly so with the
/// oscillator's curvature.
const NODES: [(f64, f64); 8] = [
    (0.019_855_071_751_231_88, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

impl<const N: usize> Transition<N> for IntegratedWiener {
    fn step(&self, _to: usize, tau: f64) -> Step<N> {
        let drift = oscillator_driven_by(|a| {
            for i in 2..N - 1 {
                a[i][i + 1] = 1.0;
            }
        });
        integrated(&drift, tau, &[(N - 1, self.intensity), (1, self.moment_noise)])
    }
}

/// The drift of `y'' + y = u` with `y`, `y'`, `u` first, completed by what moves `u`.
pub(super) fn oscillator_driven_by<const N: usize>(
    moment: impl FnOnce(&mut Matrix<N>),
) -> Matrix<N> {
    let mut a = [[0.0; N]; N];
    a[0][1] = 1.0;
    a[1][0] = -1.0;
    a[1][2] = 1.0;
    moment(&mut a);
    a
}

/// The step over `tau` of `dx = A x dt` plus white noises, each with its component and intensity.
pub(super) fn integrated<const N: usize>(
    drift: &Matrix<N>,
    tau: f64,
    noises: &[(usize, f64)],
) -> Step<N> {
    let flow = |tau: f64| exponential(&drift.map(|row| row.map(|a| a * tau)));
    let mut columns = Vec::with_capacity(NODES.len() * noises.len());
    for (node, weight) in NODES {
        let reached = flow(tau * (1.0 - node));
        let root = (weight * tau).sqrt();
        for &(component, intensity) in noises.iter().filter(|noise| noise.1 > 0.0) {
            columns.push(std::array::from_fn(|i| reached[i][component] * root * intensity));
        }
    }
    Step { f: flow(tau), g: triangular_root(&mut columns) }
}

/// The paper's discrete moment: one impulse `U dt` per sample (2.6) and independent first
/// differences (2.10).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperWalk {
    /// Standard deviation of a first difference of `u`, in units of the roll noise [-].
    pub difference: f64,
}

impl Transition<3> for PaperWalk {
    fn step(&self, _to: usize, tau: f64) -> Step<3> {
        let (sin, cos) = tau.sin_cos();
        Step {
            f: [[cos, sin, sin * tau], [-sin, cos, cos * tau], [0.0, 0.0, 1.0]],
            g: [[0.0; 3], [0.0; 3], [0.0, 0.0, self.difference]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::state_space::matrix::product;

    #[test]
    fn two_half_steps_make_one_step() {
        let prior = IntegratedWiener { intensity: 2.0, moment_noise: 0.5 };
        let (half, whole): (Step<5>, Step<5>) = (prior.step(1, 0.2), prior.step(1, 0.4));
        let moved = product(&half.f, &half.f);
        let carried = product(&half.f, &half.g);
        for i in 0..5 {
            for j in 0..5 {
                assert!((moved[i][j] - whole.f[i][j]).abs() < 1e-14);
                let sum: f64 = (0..5)
                    .map(|k| carried[i][k] * carried[j][k] + half.g[i][k] * half.g[j][k])
                    .sum();
                let direct: f64 = (0..5).map(|k| whole.g[i][k] * whole.g[j][k]).sum();
                // The quadrature is exact but for the oscillator's own curvature.
                assert!((sum - direct).abs() < 1e-13, "{i} {j}: {sum} {direct}");
            }
        }
    }
}
