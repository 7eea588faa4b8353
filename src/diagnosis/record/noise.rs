//! The noise of a record, from its own samples.

/// Standard deviation of the noise from fourth differences, which leave nothing of a smooth course
/// and 70 times the variance of a white noise.
pub(super) fn rough_noise(values: &[f64]) -> f64 {
    let square: f64 = fourth_differences(values).iter().map(|d| d * d).sum();
    (square / 70.0 / values.len().saturating_sub(4).max(1) as f64).sqrt()
}

/// Fourth differences, in which nothing is left of a smooth course.
pub(super) fn fourth_differences(v: &[f64]) -> Vec<f64> {
    v.windows(5).map(|v| v[0] - 4.0 * v[1] + 6.0 * v[2] - 4.0 * v[3] + v[4]).collect()
}
