//! The model's own waves, back from the side walls.

/// `w V/g` [-] above which the model outruns its waves (ITTC 7.5-02-07-02.1, a tank four times as
/// wide as the model is long).
const OUTRUN: f64 = 0.305;

/// `w V/g` over the value at which the model outruns its waves [-]; from one on none come back.
pub fn outrun(rolling_rad_s: f64, speed_m_s: f64, gravity_m_s2: f64) -> f64 {
    rolling_rad_s * speed_m_s / gravity_m_s2 / OUTRUN
}

/// Time [s] to a wall and back through clear water of `clear_width_m` [m] on both sides together,
/// at the group velocity `g/(2 w)` in deep water.
pub fn trip_s(clear_width_m: f64, rolling_rad_s: f64, gravity_m_s2: f64) -> f64 {
    clear_width_m * 2.0 * rolling_rad_s / gravity_m_s2
}
