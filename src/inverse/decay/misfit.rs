//! How far a damping law stands from the energy that each half cycle lost.

use crate::inverse::identification::HalfCycle;
use crate::roll::damping::{cubic_weight, equivalent_per_s};

/// Covariance of `(b1, b3)` that the law's own misfit adds: the shift that the half cycles ask for,
/// squared, with the scatter of the half cycles about the law.
///
/// The half cycles are fitted with the weights of their kinetic energy; neighbours that err alike
/// count as one, by Bartlett's weights over an eighth of the record (Newey and West 1987).
pub(super) fn covariance(half_cycles: &[HalfCycle], b1_per_s: f64, b3_s: f64) -> [[f64; 2]; 2] {
    let rows: Vec<([f64; 2], f64, f64)> = half_cycles
        .iter()
        .map(|h| {
            let cubic = cubic_weight(h.frequency_rad_s, h.amplitude_rad);
            let law = equivalent_per_s(b1_per_s, b3_s, h.frequency_rad_s, h.amplitude_rad);
            ([1.0, cubic], h.equivalent_damping_per_s.mean - law, h.amplitude_rad.powi(2))
        })
        .collect();
    let mut normal = [[0.0; 2]; 2];
    let mut pull = [0.0; 2];
    for (x, misfit, weight) in &rows {
        for i in 0..2 {
            pull[i] += weight * x[i] * misfit;
            for j in 0..2 {
                normal[i][j] += weight * x[i] * x[j];
            }
        }
    }
    let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
    if rows.len() < 4 || determinant <= 0.0 {
        return [[0.0; 2]; 2];
    }
    let inverse = [
        [normal[1][1] / determinant, -normal[0][1] / determinant],
        [-normal[1][0] / determinant, normal[0][0] / determinant],
    ];
    let times = |m: &[[f64; 2]; 2], v: &[f64; 2]| -> [f64; 2] {
        [m[0][0] * v[0] + m[0][1] * v[1], m[1][0] * v[0] + m[1][1] * v[1]]
    };
    let shift = times(&inverse, &pull);
    let scores: Vec<[f64; 2]> = rows
        .iter()
        .map(|(x, misfit, weight)| {
            let left = misfit - shift[0] * x[0] - shift[1] * x[1];
            times(&inverse, &[weight * x[0] * left, weight * x[1] * left])
        })
        .collect();
    let last = rows.len() / 8;
    let mut out = [[0.0; 2]; 2];
    for (i, row) in out.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = shift[i] * shift[j];
            for lag in 0..=last {
                let weight = 1.0 - lag as f64 / (last + 1) as f64;
                let both = if lag == 0 { 0.5 } else { 1.0 };
                *entry += both
                    * weight
                    * scores[lag..]
                        .iter()
                        .zip(&scores)
                        .map(|(a, b)| a[i] * b[j] + b[i] * a[j])
                        .sum::<f64>();
            }
        }
    }
    out
}
