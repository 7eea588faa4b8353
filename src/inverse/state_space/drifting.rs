//! A quantity that is read directly and whose rate wanders: the smoother of a moment channel.

use super::matrix::Matrix;
use super::transition::{Step, Transition, integrated};

/// `m' = v` with `v` a random walk, in scaled time; `m` is what is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drifting {
    /// Intensity of the walk, in units of the noise of a reading [-].
    pub intensity: f64,
}

impl Transition<2> for Drifting {
    fn step(&self, _to: usize, tau: f64) -> Step<2> {
        let drift: Matrix<2> = [[0.0, 1.0], [0.0, 0.0]];
        integrated(&drift, tau, &[(1, self.intensity)])
    }

    /// The quantity stands where other priors have the moment.
    fn places(&self) -> [usize; 3] {
        [0, 1, 0]
    }
}
