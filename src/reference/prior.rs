//! The printed prior (2.10) and hyperpriors (2.13): its missing rank, their hidden scale.

use faer::{Mat, Side};

use super::Erratum;

/// Number of unknowns of a typical record, for the computed examples.
const N_UNKNOWNS: usize = 200;
/// Both parameters of every hyperprior as printed.
const PRINTED_HYPERPARAMETER: f64 = 0.1;

/// The matrix `W` of (2.11) for a chain of `n` points.
fn chain_laplacian(n: usize) -> Mat<f64> {
    Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => f64::from(u8::from(i > 0)) + f64::from(u8::from(i + 1 < n)),
        1 => -1.0,
        _ => 0.0,
    })
}

/// Number of eigenvalues of `W` that are not zero to working precision; none if they are not found.
fn rank(matrix: &Mat<f64>) -> Option<usize> {
    let values = matrix.self_adjoint_eigenvalues(Side::Lower).ok()?;
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let zero = largest * matrix.nrows() as f64 * f64::EPSILON;
    Some(values.iter().filter(|value| value.abs() > zero).count())
}

/// The power of lambda in (2.10).
pub(super) fn rank_erratum() -> Erratum {
    let found = rank(&chain_laplacian(N_UNKNOWNS));
    Erratum {
        title: "The prior counts one dimension too many".to_owned(),
        printed: "(2.10): p(U) proportional to lambda^(n/2) exp(-lambda U'WU/2)".to_owned(),
        computed: found.map_or_else(
            || format!("the eigenvalues of W for n = {N_UNKNOWNS} were not found"),
            |rank| {
                format!(
                    "W has rank {rank} for n = {N_UNKNOWNS}: a constant U costs nothing, so the \
                     power is {rank}/2, not {N_UNKNOWNS}/2"
                )
            },
        ),
        how: "eigenvalues of W of (2.11) for a chain of points; one is zero to rounding".to_owned(),
    }
}

/// Noise, in the record's unit, that the hyperprior `(a, b)` leaves a perfectly fitted record.
///
/// The mean of `1/sigma^2` given no residual at all is `(m/2 + a) / b` (2.13).
fn noise_floor(n_samples: usize, a: f64, b: f64) -> f64 {
    (b / (0.5 * n_samples as f64 + a)).sqrt()
}

/// The scale hidden in the printed hyperpriors.
pub(super) fn scale_erratum() -> Erratum {
    let (n_samples, true_deg) = (500, 0.05);
    let a = PRINTED_HYPERPARAMETER;
    let floor = noise_floor(n_samples, a, a);
    let (in_rad_deg, in_deg_deg) = (floor.to_degrees(), floor);
    Erratum {
        title: "The hyperpriors have a scale, and it is not that of a roll record".to_owned(),
        printed: format!("Sec. 4.1: all four hyperparameters {PRINTED_HYPERPARAMETER}"),
        computed: format!(
            "with {n_samples} samples a record fitted without any residual is still given a noise \
             of {in_rad_deg:.2} deg, {:.0} times a sensor noise of {true_deg} deg; the same record \
             kept in degrees is given {in_deg_deg:.2} deg, {:.1} times that noise",
            in_rad_deg / true_deg,
            in_deg_deg / true_deg,
        ),
        how: "1/sigma^2 at its posterior mean (m/2 + a) / b when the residual is zero; b carries \
              the unit of the record squared, so the answer depends on that unit"
            .to_owned(),
    }
}

/// What the printed hyperpriors did to one simulated run whose truth is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperpriorCheck {
    /// True roll noise [rad].
    pub true_noise_rad: f64,
    /// Posterior mean of the roll noise under the printed hyperpriors [rad].
    pub posterior_noise_rad: f64,
    /// Share of the true moments inside their 95 % band [-].
    pub coverage: f64,
    /// Mean width of the 95 % band under the printed hyperpriors [1/s2].
    pub band_width_per_s2: f64,
    /// Mean width of the 95 % band under scale-free hyperpriors [1/s2].
    pub scale_free_band_width_per_s2: f64,
    /// Root mean square of the true moment [1/s2].
    pub moment_rms_per_s2: f64,
}

/// The erratum that a check of the printed hyperpriors amounts to.
pub fn hyperprior_erratum(check: &HyperpriorCheck) -> Erratum {
    Erratum {
        title: "The printed hyperpriors widen the band".to_owned(),
        printed: format!("Sec. 4.1: all four hyperparameters {PRINTED_HYPERPARAMETER}"),
        computed: format!(
            "true noise {:.3} deg, posterior noise {:.3} deg ({:.1} times as much); the 95 % band \
             holds {:.1} % of the true moments and is {:.2} 1/s2 wide on a moment of rms {:.2} \
             1/s2; with scale-free hyperpriors it is {:.2} 1/s2",
            check.true_noise_rad.to_degrees(),
            check.posterior_noise_rad.to_degrees(),
            check.posterior_noise_rad / check.true_noise_rad,
            100.0 * check.coverage,
            check.band_width_per_s2,
            check.moment_rms_per_s2,
            check.scale_free_band_width_per_s2,
        ),
        how: "posterior of one simulated decay, against the moment that was simulated".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_neighbour_matrix_has_rank_one_less_than_its_size() {
        for n in [2, 3, 50] {
            assert_eq!(rank(&chain_laplacian(n)), Some(n - 1));
        }
        assert!(rank_erratum().computed.contains("rank 199 for n = 200"));
    }

    #[test]
    fn the_printed_hyperprior_alone_makes_the_noise_23_times_too_large() {
        let ratio = noise_floor(500, 0.1, 0.1).to_degrees() / 0.05;
        // METHOD section 3 measured 23 on a whole posterior, whose residual adds a little.
        assert!((ratio - 23.0).abs() < 0.5, "{ratio}");
    }

    #[test]
    fn a_check_of_the_hyperpriors_is_told_with_its_ratio() {
        let computed = hyperprior_erratum(&HyperpriorCheck {
            true_noise_rad: 0.05_f64.to_radians(),
            posterior_noise_rad: 1.15_f64.to_radians(),
            coverage: 1.0,
            band_width_per_s2: 0.78,
            scale_free_band_width_per_s2: 0.25,
            moment_rms_per_s2: 0.14,
        })
        .computed;
        assert!(computed.contains("(23.0 times as much)"), "{computed}");
        assert!(computed.contains("100.0 %") && computed.contains("0.78 1/s2"), "{computed}");
    }
}
