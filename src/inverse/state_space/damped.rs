//! A damped oscillator under the noise of a measured moment and a moment that wanders beside it.

use super::matrix::Matrix;
use super::transition::{Step, Transition, integrated, oscillator_driven_by};

/// `y'' + d y' + y = u + noise`, with `u` a random walk, in scaled time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damped {
    /// Damping `d` over the natural frequency [-].
    pub damping: f64,
    /// Intensity of the walk, in units of the roll noise [-].
    pub walk: f64,
    /// Intensity of the moment's noise, in units of the roll noise [-].
    pub moment_noise: f64,
}

impl Transition<3> for Damped {
    fn step(&self, _to: usize, tau: f64) -> Step<3> {
        let drift: Matrix<3> = oscillator_driven_by(|a| a[1][1] = -self.damping);
        integrated(&drift, tau, &[(2, self.walk), (1, self.moment_noise)])
    }
}
