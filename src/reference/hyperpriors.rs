//! What the printed hyperpriors do to the posterior of one simulated decay whose truth is known.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::prior::HyperpriorCheck;
use crate::inverse::paper::exact::{ExactPosterior, exact};
use crate::inverse::paper::{Convolution, Hyperpriors, PriorPower};
use crate::inverse::state_space::posterior::Quadrature;
use crate::tank::FreeRoll;
use crate::tank::paper;

/// Noise of a good potentiometer [deg].
const NOISE_DEG: f64 = 0.05;
const RELEASE_DEG: f64 = 10.0;
/// Samples of the decay and their interval [s], as many as the paper's figures show.
const N_SAMPLES: usize = 500;
const INTERVAL_S: f64 = 0.02;
const SEED: u64 = 1;
/// Hyperparameters small enough to leave every scale to the record: `beta2` is to be far below the
/// noise's square, 8e-7 rad2, times the number of samples.
const VAGUE: f64 = 1e-9;
/// Normal quantile of a central 95 % interval.
const Z_975: f64 = 1.959_963_984_540_054;

/// Simulates a decay of the bare hull and solves it under both kinds of hyperpriors.
pub(super) fn check() -> HyperpriorCheck {
    let row = paper::BARE_HULL[2];
    let decay = FreeRoll {
        natural_frequency_rad_s: paper::NATURAL_FREQUENCY_BARE_RAD_S,
        b1_per_s: row.b1_per_s,
        b3_s: row.b3_s,
        initial_roll_rad: RELEASE_DEG.to_radians(),
        initial_roll_rate_rad_per_s: 0.0,
    };
    let motion = decay.motion(INTERVAL_S, N_SAMPLES);
    let truth: Vec<f64> =
        motion.iter().map(|(_, rate)| -row.b1_per_s * rate - row.b3_s * rate.powi(3)).collect();
    let true_noise_rad = NOISE_DEG.to_radians();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let measured: Vec<f64> = motion
        .iter()
        .map(|(roll_rad, _)| {
            let unit: f64 = StandardNormal.sample(&mut rng);
            roll_rad + true_noise_rad * unit
        })
        .collect();
    let convolution =
        Convolution::new(motion.len(), INTERVAL_S, paper::NATURAL_FREQUENCY_BARE_RAD_S)
            .expect("500 samples at 50 Hz are within the limits of the method");
    let g = convolution.observable(&measured, decay.initial_roll_rad, 0.0, None);
    let solved =
        |hyper: &Hyperpriors, power| exact(&g, &convolution, hyper, power, Quadrature::BAND);
    let printed = solved(&Hyperpriors::PAPER, PriorPower::Printed);
    let vague = Hyperpriors { alpha1: VAGUE, beta1: VAGUE, alpha2: VAGUE, beta2: VAGUE };
    let scale_free = solved(&vague, PriorPower::Rank);
    // The last moment acts on no sample of the record, so its band is the prior's alone.
    let n_acting = motion.len() - 1;
    HyperpriorCheck {
        true_noise_rad,
        posterior_noise_rad: printed.sigma_rad,
        coverage: coverage(&printed, &truth[..n_acting]),
        band_width_per_s2: width(&printed, n_acting),
        scale_free_band_width_per_s2: width(&scale_free, n_acting),
        moment_rms_per_s2: (truth.iter().map(|u| u * u).sum::<f64>() / truth.len() as f64).sqrt(),
    }
}

/// Share of the true moments inside their 95 % band [-].
fn coverage(posterior: &ExactPosterior, truth: &[f64]) -> f64 {
    let inside = truth
        .iter()
        .zip(posterior.mean.iter().zip(&posterior.sd))
        .filter(|(truth, (mean, sd))| (*truth - *mean).abs() <= Z_975 * *sd)
        .count();
    inside as f64 / truth.len() as f64
}

/// Mean width of the 95 % band over the first `n` moments [1/s2].
fn width(posterior: &ExactPosterior, n: usize) -> f64 {
    2.0 * Z_975 * posterior.sd[..n].iter().sum::<f64>() / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_hyperpriors_make_noise_and_band_too_large_and_vague_ones_do_not() {
        let check = check();
        // The prior alone asks for 23 times the noise (see `prior`); the residual adds a little.
        let ratio = check.posterior_noise_rad / check.true_noise_rad;
        assert!((20.0..30.0).contains(&ratio), "{ratio}");
        // A 95 % band that holds all of 499 moments is too wide at any significance.
        assert!(check.coverage > 0.99, "{}", check.coverage);
        assert!(check.scale_free_band_width_per_s2 < 0.5 * check.band_width_per_s2, "{check:?}");
        assert!(check.band_width_per_s2 > check.moment_rms_per_s2, "{check:?}");
    }
}
