//! Equivalent damping of a decay at the reported amplitudes.

use super::fit::{CURVE, N_UNKNOWNS};
use super::half_cycles::local_damping;
use super::posterior::DecayPosterior;
use crate::inverse::amplitudes::{AMPLITUDES_DEG, is_compared};
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{DampingFit, EquivalentDamping, HalfCycle};
use crate::inverse::mixture::{self, Component};
use crate::roll::damping::cubic_weight;

/// Components of the equivalent damping [1/s] at an amplitude [rad].
///
/// Where the law holds it is the law's, whatever its form. Where it leaves a moment, that moment
/// works too, so the energy that the half cycles `near` the amplitude lost takes its place.
pub fn components(
    posterior: &DecayPosterior,
    frequency_rad_s: f64,
    amplitude_rad: f64,
    near: Option<Estimate>,
) -> Vec<Component> {
    let mut weights = [0.0; N_UNKNOWNS];
    let equivalents = posterior.linearised.scale.equivalents(frequency_rad_s * amplitude_rad);
    weights[CURVE..].copy_from_slice(&equivalents);
    let mut components = posterior.combination(&weights);
    if let Some(near) = near {
        for (component, weighed) in components.iter_mut().zip(&posterior.solutions) {
            if posterior.disturbances[weighed.disturbance].misfit.is_some() {
                (component.mean, component.sd) = (near.mean, near.sd.max(component.sd));
            }
        }
    }
    components
}

/// The reported amplitudes with the damping by the posterior, or by the law that the paper's chain
/// found, and by the half cycles near each.
pub(super) fn equivalent_damping(
    posterior: &DecayPosterior,
    scatter_fit: Option<&DampingFit>,
    frequency_rad_s: f64,
    b3_s: f64,
    cycles: &[HalfCycle],
) -> Vec<EquivalentDamping> {
    let motion = &posterior.linearised.motion;
    let largest_rad = motion.iter().map(|m| m.roll_rad.abs()).fold(0.0, f64::max);
    let smallest_rad = cycles.iter().map(|c| c.amplitude_rad).fold(f64::INFINITY, f64::min);
    let fitted = |amplitude_rad: f64, near: Option<Estimate>| -> Estimate {
        match scatter_fit {
            Some(fit) => fit.combination(1.0, cubic_weight(frequency_rad_s, amplitude_rad)),
            None => mixture::estimate(&components(posterior, frequency_rad_s, amplitude_rad, near)),
        }
    };
    let is_near = |amplitude_deg: &f64| {
        (0.8 * smallest_rad..=1.25 * largest_rad).contains(&amplitude_deg.to_radians())
            || is_compared(*amplitude_deg)
    };
    let at = |amplitude_deg: f64| {
        let amplitude_rad = amplitude_deg.to_radians();
        let near = local_damping(cycles, amplitude_rad, b3_s);
        EquivalentDamping {
            amplitude_deg,
            fitted_per_s: fitted(amplitude_rad, near),
            local_per_s: near,
            extrapolated: !(smallest_rad..=largest_rad).contains(&amplitude_rad),
        }
    };
    AMPLITUDES_DEG.into_iter().filter(is_near).map(at).collect()
}
