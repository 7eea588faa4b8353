//! The roll amplitudes at which every run reports its equivalent damping.

/// Amplitudes [deg] at which equivalent damping is reported, where the run comes near them.
pub(super) const AMPLITUDES_DEG: [f64; 11] =
    [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0];

/// Whether this amplitude [deg] is reported for every run, so that all runs can be compared.
pub(super) fn is_compared(amplitude_deg: f64) -> bool {
    (amplitude_deg - 5.0).abs() < 1e-9
}
