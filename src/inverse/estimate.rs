//! A number that is not known exactly: mean, standard deviation and 95 % interval.

use serde::Serialize;

/// The marginal posterior of one quantity, in the quantity's own unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
    /// Lower end of the central 95 % credible interval.
    pub lo95: f64,
    /// Upper end of the central 95 % credible interval.
    pub hi95: f64,
}

impl Estimate {
    /// The estimate of a normal posterior.
    pub fn normal(mean: f64, sd: f64) -> Self {
        const Z_975: f64 = 1.959_963_984_540_054;
        Self { mean, sd, lo95: mean - Z_975 * sd, hi95: mean + Z_975 * sd }
    }

    /// The same quantity in another unit, `factor` of the new unit making one of the old.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let (a, b) = (self.lo95 * factor, self.hi95 * factor);
        Self {
            mean: self.mean * factor,
            sd: self.sd * factor.abs(),
            lo95: a.min(b),
            hi95: a.max(b),
        }
    }

    /// Whether the 95 % interval holds `value`.
    pub fn covers(&self, value: f64) -> bool {
        self.lo95 <= value && value <= self.hi95
    }
}
