//! The damping law of a decay with what it leaves unexplained.

use super::fit::{B1, B3, DecayPosterior, N_UNKNOWNS};
use super::half_cycles;
use super::misfit;
use crate::inverse::amplitudes::{AMPLITUDES_DEG, is_compared};
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{DampingFit, EquivalentDamping, HalfCycle};
use crate::inverse::mixture;
use crate::roll::damping::cubic_weight;

/// The fitted law with what its misfit adds to its covariance.
pub(super) struct Law<'a> {
    fit: &'a DecayPosterior,
    misfit: [[f64; 2]; 2],
}

impl<'a> Law<'a> {
    pub(super) fn new(fit: &'a DecayPosterior, cycles: &[HalfCycle]) -> Self {
        let probability: f64 =
            fit.solutions.iter().map(|s| s.weight * s.probability_of_misfit).sum();
        let mean = |position| mixture::estimate(&fit.unknown(position)).mean;
        let misfit = if probability > 0.5 {
            misfit::covariance(cycles, mean(B1), mean(B3))
        } else {
            [[0.0; 2]; 2]
        };
        Self { fit, misfit }
    }

    /// Standard deviations that the misfit adds to `b1` [1/s] and `b3` [s].
    pub(super) fn misfit_sd(&self) -> (f64, f64) {
        (self.misfit[0][0].max(0.0).sqrt(), self.misfit[1][1].max(0.0).sqrt())
    }

    /// Estimate of `a b1 + c b3`.
    pub(super) fn combination(&self, a: f64, c: f64) -> Estimate {
        let mut weights = [0.0; N_UNKNOWNS];
        (weights[B1], weights[B3]) = (a, c);
        let mut components = self.fit.combination(&weights);
        let m = &self.misfit;
        let added = a * a * m[0][0] + 2.0 * a * c * m[0][1] + c * c * m[1][1];
        for component in &mut components {
            component.sd = (component.sd.powi(2) + added.max(0.0)).sqrt();
        }
        mixture::estimate(&components)
    }

    /// The law's two coefficients.
    pub(super) fn damping(&self) -> DampingFit {
        let (b1_per_s, b3_s) = (self.combination(1.0, 0.0), self.combination(0.0, 1.0));
        // Scaled to unit deviations, the variance of the sum is 2 + 2 correlation.
        let sum = self.combination(b1_per_s.sd.recip(), b3_s.sd.recip());
        let correlation = (0.5 * sum.sd.powi(2) - 1.0).clamp(-1.0, 1.0);
        DampingFit { b1_per_s, b3_s, correlation }
    }
}

/// Equivalent damping at the reported amplitudes by a law, with the half cycles' own beside it.
///
/// The law is given for each weight of its cubic coefficient [1/s2]; `largest_rad` [rad] is the
/// roll that the run reached.
pub(super) fn equivalent_damping(
    law: impl Fn(f64) -> Estimate,
    b3_s: f64,
    cycles: &[HalfCycle],
    largest_rad: f64,
    frequency_rad_s: f64,
) -> Vec<EquivalentDamping> {
    let smallest = cycles.iter().map(|c| c.amplitude_rad).fold(f64::INFINITY, f64::min);
    let near = |amplitude_deg: f64| {
        let amplitude_rad = amplitude_deg.to_radians();
        (0.8 * smallest..=1.25 * largest_rad).contains(&amplitude_rad) || is_compared(amplitude_deg)
    };
    let at = |amplitude_deg: f64| {
        let amplitude_rad = amplitude_deg.to_radians();
        EquivalentDamping {
            amplitude_deg,
            fitted_per_s: law(cubic_weight(frequency_rad_s, amplitude_rad)),
            local_per_s: half_cycles::local_damping(cycles, amplitude_rad, b3_s),
            extrapolated: !(smallest..=largest_rad).contains(&amplitude_rad),
        }
    };
    AMPLITUDES_DEG.into_iter().filter(|a| near(*a)).map(at).collect()
}
