//! The speed law (4.3) fitted to Table 2 by least squares, with its standard errors.

use faer::Mat;
use faer::prelude::SolveLstsq;

use super::Erratum;
use crate::tank::DampingRow;
use crate::tank::paper;

/// `b1 = b0 + slope Fr^2`, that is `b0 (1 + kappa Fr^2)`, by ordinary least squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpeedLaw {
    /// Linear damping at rest [1/s].
    pub(super) b0_per_s: f64,
    /// Rise of `b1` with `Fr^2` [1/s].
    pub(super) slope_per_s: f64,
    /// Speed coefficient [-].
    pub(super) kappa: f64,
    /// Standard error of `kappa` [-].
    pub(super) kappa_error: f64,
    /// Standard deviation of the rows about the law [1/s].
    pub(super) scatter_per_s: f64,
}

/// Fits (4.3) to the rows of a table, at least three of them.
///
/// `kappa = slope / b0`, its standard error to first order from the covariance of both.
pub(super) fn fit(rows: &[DampingRow]) -> SpeedLaw {
    let n = rows.len();
    let design = Mat::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { rows[i].froude.powi(2) });
    let observed = Mat::from_fn(n, 1, |i, _| rows[i].b1_per_s);
    let qr = design.qr();
    let solution = qr.solve_lstsq(&observed);
    let (b0, slope) = (solution[(0, 0)], solution[(1, 0)]);
    let residual = &observed - &design * &solution;
    let variance = residual.squared_norm_l2() / (n as f64 - 2.0);
    // With X = Q R, (X'X)^-1 = R^-1 R^-T, so the gradient needs one triangular solve with R'.
    let r = qr.thin_R();
    let gradient = [-slope / (b0 * b0), 1.0 / b0];
    let first = gradient[0] / r[(0, 0)];
    let second = (gradient[1] - r[(0, 1)] * first) / r[(1, 1)];
    SpeedLaw {
        b0_per_s: b0,
        slope_per_s: slope,
        kappa: slope / b0,
        kappa_error: (variance * (first * first + second * second)).sqrt(),
        scatter_per_s: variance.sqrt(),
    }
}

/// The printed kappa against the fitted one.
pub(super) fn kappa_erratum() -> Erratum {
    let [bare, keels] = [fit(&paper::BARE_HULL), fit(&paper::BILGE_KEELS)];
    let [printed_bare, printed_keels] = paper::PRINTED_KAPPA;
    Erratum {
        title: "kappa does not follow from Table 2".to_owned(),
        printed: format!(
            "Sec. 4.1: kappa = {printed_bare} without and {printed_keels} with bilge keels"
        ),
        computed: format!(
            "kappa = {:.1} +- {:.1} for the bare hull and {:.1} +- {:.1} with bilge keels; the \
             printed values are near the absolute slopes b0 kappa = {:.2} and {:.2} 1/s",
            bare.kappa,
            bare.kappa_error,
            keels.kappa,
            keels.kappa_error,
            bare.slope_per_s,
            keels.slope_per_s,
        ),
        how: "least squares of b1 = b0 + (b0 kappa) Fr^2 over the five rows of each condition; \
              one standard error, to first order"
            .to_owned(),
    }
}

/// What the fitted kappa do to the paper's comparison of the two conditions.
pub(super) fn comparison_erratum() -> Erratum {
    let [bare, keels] = [fit(&paper::BARE_HULL), fit(&paper::BILGE_KEELS)];
    let difference = keels.kappa - bare.kappa;
    let error = bare.kappa_error.hypot(keels.kappa_error);
    Erratum {
        title: "Speed does not matter more with bilge keels".to_owned(),
        printed: "Sec. 4.1: the effect of forward speed is much greater with bilge keels"
            .to_owned(),
        computed: format!(
            "relative to the damping at rest the two effects differ by {difference:.1} +- \
             {error:.1} in kappa; in absolute terms the slope is {:.1} times larger, as is the \
             damping at rest by {:.1} times",
            keels.slope_per_s / bare.slope_per_s,
            keels.b0_per_s / bare.b0_per_s,
        ),
        how: "difference of the two least-squares kappa with its standard error, and the ratio of \
              the slopes b0 kappa"
            .to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_gives_the_known_values_of_both_conditions() {
        // Pinned to the digits that were computed once with an independent program.
        let cases = [
            (&paper::BARE_HULL, 11.786_212, 3.606_427, 4.319_655, 0.094_585, 0.258),
            (&paper::BILGE_KEELS, 11.936_318, 2.942_223, 13.223_448, 0.231_780, 0.209),
        ];
        for (rows, kappa, error, slope, scatter, share) in cases {
            let law = fit(rows);
            assert!((law.kappa - kappa).abs() < 1e-5, "{law:?}");
            assert!((law.kappa_error - error).abs() < 1e-5, "{law:?}");
            assert!((law.slope_per_s - slope).abs() < 1e-5, "{law:?}");
            assert!((law.scatter_per_s - scatter).abs() < 1e-5, "{law:?}");
            assert!((law.scatter_per_s / law.b0_per_s - share).abs() < 1e-3, "{law:?}");
        }
    }

    #[test]
    fn rows_that_keep_the_law_give_it_back_without_scatter() {
        let rows = [0.0, 0.1, 0.25, 0.4].map(|froude: f64| DampingRow {
            froude,
            b1_per_s: 0.5 * (1.0 + 7.0 * froude.powi(2)),
            b3_s: 0.1,
        });
        let law = fit(&rows);
        assert!((law.kappa - 7.0).abs() < 1e-12 && law.scatter_per_s < 1e-12, "{law:?}");
    }

    #[test]
    fn the_erratum_carries_the_rounded_values() {
        let computed = kappa_erratum().computed;
        for text in ["11.8 +- 3.6", "11.9 +- 2.9", "4.32", "13.22 1/s"] {
            assert!(computed.contains(text), "{computed}");
        }
    }
}
