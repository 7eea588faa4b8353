//! What an error of the time between roll and moment does to a forced run.
//!
//! A moment that is stamped late by `d` is read as `M(t - d) = M(t) - d M'(t)`. In steady motion
//! `phi = A cos(w t)`, `M = I phi'' + B phi' + K phi` leads by `eps` with `|M| sin(eps) = B w A`
//! and `|M| cos(eps) = (K - I w^2) A`, so that the delay turns `eps` by `-w d` and
//!
//! `dB = -|M| cos(eps) d/A = -(K - I w^2) d`,  `dI = -B d`:
//!
//! restoring less inertia passes for damping. It is nil at resonance, and over `2 I w0` it is the
//! `dzeta = (w0 d/2)(1 - (w/w0)^2)` of captive tests. The error is one for the whole run and does
//! not average out: a rectangular bound with its standard uncertainty beside the statistical one
//! (GUM, JCGM 100:2008, 4.3.7 and 5.1.2).

use crate::inverse::identification::{MomentHistory, Skew};
use crate::run::Timing;

/// A remark for a run of which nobody knows how its channels lie in time.
pub(super) const NOT_STATED: &str = "no bound of the time between roll and moment is stated, so \
    that none is in the bands";

/// What the timing of a run leaves unsure, where it is stated and not nil.
pub(super) fn sd_s(timing: &Timing) -> f64 {
    timing.skew_sd_s().unwrap_or(0.0)
}

/// The effect on the damping per unit inertia, from that of a unit delay on inertia [kg m2/s] and
/// damping [N m s/s, N m s3/s].
pub(super) fn of(timing: &Timing, values: [f64; 3], by_s: [f64; 3]) -> Option<Skew> {
    let [inertia, linear, cubic] = values;
    let per_inertia = |damping: f64, by: f64| (by - damping / inertia * by_s[0]) / inertia;
    Some(Skew {
        sd_s: timing.skew_sd_s()?,
        b1_by_per_s2: per_inertia(linear, by_s[1]),
        b3_by: per_inertia(cubic, by_s[2]),
    })
}

/// Widens a moment history by a moment [rad/s2 per s] that an unknown delay lays over it.
pub(super) fn widen(history: &mut MomentHistory, sd_s: f64, rate: impl Fn(f64) -> f64) {
    if sd_s == 0.0 {
        return;
    }
    for i in 0..history.time_s.len() {
        let before = history.sd_per_s2[i];
        let sd = before.hypot(sd_s * rate(history.time_s[i]));
        // A band that a chain has drawn need not be that of a normal.
        let wider = if before > 0.0 { sd / before } else { 1.0 };
        let mean = history.mean_per_s2[i];
        history.lo95_per_s2[i] = mean + wider * (history.lo95_per_s2[i] - mean);
        history.hi95_per_s2[i] = mean + wider * (history.hi95_per_s2[i] - mean);
        history.sd_per_s2[i] = sd;
    }
}
