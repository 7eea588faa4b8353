//! Damping that the base does not have: other powers of the roll rate, friction.

use crate::hidden_tank::effect::{Acting, Row};

/// Amplitude times natural frequency at 10 degrees [rad/s], where laws of damping are matched.
fn matched_rate(natural_rad_s: f64) -> f64 {
    natural_rad_s * 10.0_f64.to_radians()
}

/// `B2 phi'|phi'|`; `B2/I` 0.05 to 0.3 (naked), middle 0.12; four times that with bilge keels.
pub(super) const QUADRATIC: Row = Row {
    id: "damping.quadratic",
    symbols: &["B2 [N m s2]"],
    draw: |size, _, base| {
        // The drag grows with what else damps the hull: the keels are 0.45.
        let by_inertia = if base.b0 / base.inertia > 0.8 { 0.45 } else { 0.12 };
        vec![size * by_inertia * base.inertia]
    },
    hide: |values| Acting::hidden(values, |v, at| -v[0] * at.rate * at.rate.abs()),
};

/// `Bp phi'|phi'|^(p-1)`, p 1.3 to 1.8; the size 1 equals the base's cubic damping at 10 degrees.
pub(super) const POWER_LAW: Row = Row {
    id: "damping.power_law",
    symbols: &["Bp [N m s^p]", "p [-]"],
    draw: |size, draw, base| {
        let p = draw.between(1.3, 1.8);
        // B_eq of a power by its mean over a circle, numerically: 3/4 for p = 3.
        let mean = |p: f64| {
            let angle = |k: i32| std::f64::consts::PI * (f64::from(k) + 0.5) / 400.0;
            (0..400).map(|k| angle(k).sin().powf(p + 1.0)).sum::<f64>() / 200.0
        };
        let rate = matched_rate(base.natural_rad_s());
        let value = base.b3 * rate.powi(2) * mean(3.0) / (rate.powf(p - 1.0) * mean(p));
        vec![size * value, p]
    },
    hide: |values| {
        Acting::hidden(values, |v, at| -v[0] * at.rate.abs().powf(v[1]) * at.rate.signum())
    },
};

/// `B5 phi'^5`; at most 0.2 of `B3` (s2), middle 0.1.
pub(super) const QUINTIC: Row = Row {
    id: "damping.quintic",
    symbols: &["B5 [N m s5]"],
    draw: |size, _, base| vec![size * 0.1 * base.b3],
    hide: |values| Acting::hidden(values, |v, at| -v[0] * at.rate.powi(5)),
};

/// Bearing friction `Mf tanh(phi'/v)`; Mf 0.002 to 0.05 N m, middle 0.01; v 0.005 to 0.05 rad/s.
pub(super) const COULOMB: Row = Row {
    id: "damping.coulomb",
    symbols: &["Mf [N m]", "v [rad/s]"],
    draw: |size, draw, _| vec![size * 0.01, draw.between(0.005, 0.05)],
    hide: |values| Acting::hidden(values, |v, at| -v[0] * (at.rate / v[1]).tanh()),
};

/// `Bphi phi^2 phi'`; the size 1 is as strong as the base's cubic: `Bphi = 3 wn^2 B3`.
pub(super) const DISPLACEMENT_WEIGHTED: Row = Row {
    id: "damping.displacement_weighted",
    symbols: &["Bphi [N m s]"],
    draw: |size, _, base| vec![size * 3.0 * base.natural_rad_s().powi(2) * base.b3],
    hide: |values| Acting::hidden(values, |v, at| -v[0] * at.roll.powi(2) * at.rate),
};
