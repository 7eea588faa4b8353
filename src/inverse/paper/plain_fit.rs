//! The damping law fitted to the scatter of moments against roll rate, as Sec. 4.1 does.

use crate::inverse::estimate::Estimate;
use crate::inverse::identification::DampingFit;
use crate::inverse::state_space::triangle::Triangle;

/// Least squares of `-E[U] = b1 phi' + b3 phi'^3`, every point alike.
pub fn plain_fit(rate_rad_per_s: &[f64], moment_per_s2: &[f64]) -> DampingFit {
    let mut triangle = Triangle::new(3);
    for (rate, moment) in rate_rad_per_s.iter().zip(moment_per_s2) {
        triangle.push([*rate, rate.powi(3), -moment]);
    }
    triangle.settle();
    let values: Vec<f64> = triangle.explained_by(2, 2).iter().map(|w| -w).collect();
    let noise = triangle.at(2, 2).abs() / (rate_rad_per_s.len() as f64 - 2.0).sqrt();
    let (r11, r12, r22) = (triangle.at(0, 0), triangle.at(0, 1), triangle.at(1, 1));
    let b3_sd = noise / r22.abs();
    let b1_sd = noise * (1.0 + (r12 / r22).powi(2)).sqrt() / r11.abs();
    let correlation = -(r12 / r22) * r22.signum() * r11.signum() * r22.signum()
        / (1.0 + (r12 / r22).powi(2)).sqrt();
    DampingFit {
        b1_per_s: Estimate::normal(values[0], b1_sd),
        b3_s: Estimate::normal(values[1], b3_sd),
        correlation,
    }
}
