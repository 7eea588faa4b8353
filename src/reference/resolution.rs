//! How well one decay can tell its damping from its sensor noise, against the scatter of Table 2.

use faer::{Mat, Side};

use super::Erratum;
use super::speed_law::fit;
use crate::tank::DampingRow;
use crate::tank::FreeRoll;
use crate::tank::paper;

/// Roll noise of the comparison [deg].
const NOISE_DEG: f64 = 0.05;
/// Sample rate of the comparison [Hz].
const SAMPLE_RATE_HZ: f64 = 100.0;
/// Length of the record [s].
const RECORD_S: f64 = 20.0;
/// Roll at the release [deg].
const RELEASE_DEG: f64 = 10.0;
/// Unknowns of a decay: b1, b3, natural frequency, initial roll and rate, zero offset.
const N_UNKNOWNS: usize = 6;

/// Smallest standard deviation of `b1` [1/s] that any unbiased estimate from one decay can have.
///
/// Cramer-Rao: the inverse of `J'J / sigma^2`, with `J` the central differences of the simulated
/// roll in every unknown. None when the record does not hold all unknowns.
fn b1_deviation_per_s(row: DampingRow, natural_frequency_rad_s: f64) -> Option<f64> {
    let truth =
        [row.b1_per_s, row.b3_s, natural_frequency_rad_s, RELEASE_DEG.to_radians(), 0.0, 0.0];
    // Steps of a thousandth of each unknown's natural size: errors of 1e-6, far from rounding.
    let step = [1e-3, 1e-3, 1e-3, 1e-4, 1e-3, 1e-4];
    let columns: Vec<Vec<f64>> = (0..N_UNKNOWNS)
        .map(|which| {
            let shifted = |sign: f64| {
                let mut unknowns = truth;
                unknowns[which] += sign * step[which];
                roll(&unknowns)
            };
            let (plus, minus) = (shifted(1.0), shifted(-1.0));
            plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * step[which])).collect()
        })
        .collect();
    let noise_rad = NOISE_DEG.to_radians();
    let information = Mat::from_fn(N_UNKNOWNS, N_UNKNOWNS, |i, j| {
        columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum::<f64>() / noise_rad.powi(2)
    });
    let inverse =
        faer::linalg::solvers::DenseSolveCore::inverse(&information.llt(Side::Lower).ok()?);
    Some(inverse[(0, 0)].sqrt())
}

fn roll(unknowns: &[f64; N_UNKNOWNS]) -> Vec<f64> {
    let &[b1_per_s, b3_s, natural_frequency_rad_s, initial_roll_rad, rate, offset_rad] = unknowns;
    let decay = FreeRoll {
        natural_frequency_rad_s,
        b1_per_s,
        b3_s,
        initial_roll_rad,
        initial_roll_rate_rad_per_s: rate,
    };
    let n_samples = (RECORD_S * SAMPLE_RATE_HZ) as usize;
    let motion = decay.motion(1.0 / SAMPLE_RATE_HZ, n_samples);
    motion.into_iter().map(|(roll_rad, _)| roll_rad + offset_rad).collect()
}

/// Scatter of a condition's rows about the law.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scatter {
    /// As a share of the damping at rest [-].
    share: f64,
    /// Over the noise limit of a row, least and most over the rows [-].
    over_limit: [f64; 2],
}

fn scatter(rows: &[DampingRow], natural_frequency_rad_s: f64) -> Option<Scatter> {
    let law = fit(rows);
    let mut over_limit = [f64::INFINITY, 0.0];
    for row in rows {
        let ratio = law.scatter_per_s / b1_deviation_per_s(*row, natural_frequency_rad_s)?;
        over_limit = [over_limit[0].min(ratio), over_limit[1].max(ratio)];
    }
    Some(Scatter { share: law.scatter_per_s / law.b0_per_s, over_limit })
}

/// The scatter of Table 2 that noise does not explain.
pub(super) fn erratum() -> Erratum {
    let both = [
        ("bare hull", &paper::BARE_HULL, paper::NATURAL_FREQUENCY_BARE_RAD_S),
        ("bilge keels", &paper::BILGE_KEELS, paper::NATURAL_FREQUENCY_KEELS_RAD_S),
    ];
    let told: Vec<String> = both
        .into_iter()
        .map(|(name, rows, w)| {
            scatter(rows, w).map_or_else(
                || format!("{name}: the noise limit was not found"),
                |Scatter { share, over_limit: [least, most] }| {
                    format!(
                        "{name}: {:.0} % of b0, {least:.0} to {most:.0} times what sensor noise \
                         allows a row, most at low speed",
                        100.0 * share
                    )
                },
            )
        })
        .collect();
    Erratum {
        title: "The scatter of Table 2 is not sensor noise".to_owned(),
        printed: "Fig. 14: the rows scatter about the fitted law, without a word on why".to_owned(),
        computed: format!("standard deviation about the law: {}", told.join("; ")),
        how: format!(
            "residuals of the least-squares law against the Cramer-Rao limit of one simulated \
             decay per row: {RELEASE_DEG} deg, {RECORD_S} s, {SAMPLE_RATE_HZ} Hz, {NOISE_DEG} deg \
             noise, {N_UNKNOWNS} unknowns"
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_decay_knows_its_linear_damping_to_half_a_per_cent_or_better() {
        let row = paper::BARE_HULL[0];
        let deviation = b1_deviation_per_s(row, paper::NATURAL_FREQUENCY_BARE_RAD_S).unwrap();
        let share = deviation / row.b1_per_s;
        // EFFECTS section 0 has 0.15 to 0.5 % for both conditions.
        assert!((0.0015..0.005).contains(&share), "{share}");
    }

    #[test]
    fn the_scatter_is_tens_of_times_the_noise_limit_in_every_row() {
        // Pinned to an independent calculation with another integrator; three digits were kept.
        let cases = [
            (&paper::BARE_HULL, paper::NATURAL_FREQUENCY_BARE_RAD_S, 0.258, [28.8, 127.3]),
            (&paper::BILGE_KEELS, paper::NATURAL_FREQUENCY_KEELS_RAD_S, 0.209, [13.5, 57.2]),
        ];
        for (rows, w, share, over_limit) in cases {
            let found = scatter(rows, w).unwrap();
            assert!((found.share - share).abs() < 5e-4, "{found:?}");
            for (ratio, pinned) in found.over_limit.into_iter().zip(over_limit) {
                assert!((ratio / pinned - 1.0).abs() < 0.005, "{found:?}");
            }
        }
    }
}
