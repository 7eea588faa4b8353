//! Which column of Table 2 is which condition.

use super::Erratum;
use crate::tank::paper;

/// Roll rate at which Fig. 12 ends [rad/s].
const FIGURE_RATE_RAD_PER_S: f64 = 1.0;
/// Value that the curve of Fig. 12(b), with bilge keels, reaches there [1/s2].
const FIGURE_VALUE_PER_S2: f64 = 2.0;
/// The row of Table 2 that Fig. 12 shows: Fr 0.2.
const FIGURE_ROW: usize = 2;

/// `b1 phi' + b3 phi'^3` at the end of Fig. 12 [1/s2], small and large column.
fn at_figure_end() -> [f64; 2] {
    [&paper::BARE_HULL, &paper::BILGE_KEELS].map(|rows| {
        let (row, rate) = (rows[FIGURE_ROW], FIGURE_RATE_RAD_PER_S);
        row.b1_per_s * rate + row.b3_s * rate.powi(3)
    })
}

/// The exchanged column heads.
pub(super) fn erratum() -> Erratum {
    let [small, large] = at_figure_end();
    Erratum {
        title: "The column heads of Table 2 are exchanged".to_owned(),
        printed: "Table 2: the small coefficients stand under \"with BK\"".to_owned(),
        computed: format!(
            "at Fr {} and {FIGURE_RATE_RAD_PER_S} rad/s the small coefficients give {small:.3} \
             1/s2 and the large ones {large:.3} 1/s2; Fig. 12(b), with bilge keels, reaches \
             {FIGURE_VALUE_PER_S2:.1} 1/s2, so the large ones are those with bilge keels",
            paper::BARE_HULL[FIGURE_ROW].froude,
        ),
        how: "b1 phi' + b3 phi'^3 with both columns against the end of the curve in Fig. 12(b)"
            .to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_large_coefficients_reach_the_end_of_the_curve_with_bilge_keels() {
        let [small, large] = at_figure_end();
        // The figure can be read to about a fiftieth of its axis.
        assert!((large - FIGURE_VALUE_PER_S2).abs() < 0.04, "{large}");
        assert!((small - 0.5422).abs() < 1e-9, "{small}");
        assert!(erratum().computed.contains("1.999 1/s2"));
    }
}
