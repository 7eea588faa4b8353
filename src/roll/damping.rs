//! Equivalent linear damping and its non-dimensional forms.

/// Equivalent linear damping `b_eq = b1 + 3/4 (w A)^2 b3` [1/s] at roll amplitude `A` [rad] and
/// frequency `w` [rad/s]: equal energy per cycle, ITTC 7.5-02-07-04.5 (2021).
pub fn equivalent_per_s(b1_per_s: f64, b3_s: f64, frequency_rad_s: f64, amplitude_rad: f64) -> f64 {
    b1_per_s + cubic_weight(frequency_rad_s, amplitude_rad) * b3_s
}

/// Weight `3/4 (w A)^2` [1/s2] of the cubic coefficient in the equivalent damping.
pub fn cubic_weight(frequency_rad_s: f64, amplitude_rad: f64) -> f64 {
    0.75 * (frequency_rad_s * amplitude_rad).powi(2)
}

/// Critical damping ratio `zeta = b_eq / (2 w)` [-].
pub fn critical_ratio(equivalent_per_s: f64, natural_frequency_rad_s: f64) -> f64 {
    equivalent_per_s / (2.0 * natural_frequency_rad_s)
}
