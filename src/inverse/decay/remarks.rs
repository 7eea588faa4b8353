//! What a reader of a decay's numbers must know beside them.

use super::beliefs::misfit;
use super::fit::FREQUENCY;
use super::form::{CUBIC, FORMS};
use super::posterior::DecayPosterior;
use crate::inverse::mixture;

/// Sentences about what the law of Sec. 4.1 with linear restoring does not capture.
pub(super) fn remarks(posterior: &DecayPosterior) -> Vec<String> {
    let mut remarks = Vec::new();
    if posterior.probability(|w, _| w.cubic_restoring) > 0.95 {
        let k3 = mixture::estimate(&posterior.cubic_restoring());
        let small = mixture::estimate(&posterior.unknown(FREQUENCY)).mean;
        let at_ten = small * (1.0 + 0.375 * k3.mean * 10_f64.to_radians().powi(2));
        let residual = &posterior.linearised.residual_rad;
        let square: f64 = residual.iter().map(|r| r * r).sum();
        let left_deg = (square / residual.len() as f64).sqrt().to_degrees();
        remarks.push(format!(
            "linear restoring does not capture that the frequency changes with amplitude, from \
             {small:.3} rad/s at small angles to {at_ten:.3} rad/s at 10 deg: a restoring moment \
             K (phi + k3 phi^3) with k3 = {:.2} [{:.2}, {:.2}] 1/rad2 leaves {left_deg:.3} deg rms",
            k3.mean, k3.lo95, k3.hi95
        ));
    }
    let cubic_law = posterior.probability(|w, _| w.form == CUBIC);
    if cubic_law < 0.05 {
        let likeliest = &FORMS[posterior.solutions[0].form];
        remarks.push(format!(
            "the evidence favours {} over b1 phi' + b3 phi'^3, whose coefficients are given all \
             the same",
            likeliest.equation
        ));
    }
    if misfit(posterior) > 0.5 {
        let largest = posterior
            .solutions
            .iter()
            .find_map(|w| {
                let misfit = posterior.disturbances[w.disturbance].misfit?;
                let w0 = posterior.linearised.point.decay.natural_frequency_rad_s;
                let sd = misfit.sd * w.solution.noise_variance_rad2().sqrt() * w0 * w0;
                Some((misfit.order, sd))
            })
            .unwrap_or((1, 0.0));
        remarks.push(format!(
            "no law of the rate alone explains the record: it leaves more than noise, a moment of \
             about {:.3} rad/s2 at the start whose derivative number {} is rough",
            largest.1, largest.0
        ));
    }
    remarks
}
