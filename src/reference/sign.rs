//! The sign of the integral equation (2.2), by quadrature of a simulated decay.

use super::Erratum;
use crate::tank::FreeRoll;
use crate::tank::paper;

/// `g` over the printed right-hand side of (2.2), least squares over the record [-].
fn printed_sign() -> f64 {
    let row = paper::BARE_HULL[2];
    let w = paper::NATURAL_FREQUENCY_BARE_RAD_S;
    let interval_s = 0.002;
    let decay = FreeRoll {
        natural_frequency_rad_s: w,
        b1_per_s: row.b1_per_s,
        b3_s: row.b3_s,
        initial_roll_rad: 10.0_f64.to_radians(),
        initial_roll_rate_rad_per_s: 0.0,
    };
    let motion = decay.motion(interval_s, 3001);
    // x1 = cos(w t) and x2 = sin(w t)/w, so the kernel x1(tau) x2(t) - x1(t) x2(tau) splits into
    // two running integrals, here by the trapezoidal rule; W = 1.
    let (mut with_x1, mut with_x2) = (0.0, 0.0);
    let mut previous: Option<(f64, f64)> = None;
    let (mut product, mut square) = (0.0, 0.0);
    for (k, &(roll_rad, rate)) in motion.iter().enumerate() {
        let t = k as f64 * interval_s;
        let (x1, x2) = ((w * t).cos(), (w * t).sin() / w);
        let b = row.b1_per_s * rate + row.b3_s * rate.powi(3);
        let (now_1, now_2) = (x1 * b, x2 * b);
        if let Some((before_1, before_2)) = previous.replace((now_1, now_2)) {
            with_x1 += 0.5 * interval_s * (before_1 + now_1);
            with_x2 += 0.5 * interval_s * (before_2 + now_2);
        }
        let printed = x2 * with_x1 - x1 * with_x2;
        let g = roll_rad - decay.initial_roll_rad * x1;
        product += g * printed;
        square += printed * printed;
    }
    product / square
}

/// The missing minus sign.
pub(super) fn erratum() -> Erratum {
    Erratum {
        title: "The integral equation lacks a minus sign".to_owned(),
        printed: "(2.2): g = + integral of the kernel times B".to_owned(),
        computed: format!(
            "g of (2.4) is {:.4} times the printed integral; Sec. 4.1 uses the right sign, as its \
             unknown is -B",
            printed_sign()
        ),
        how: format!(
            "quadrature of both sides over 6 s of a decay simulated with the bare hull's row at \
             Fr {}",
            paper::BARE_HULL[2].froude
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_integral_is_minus_the_observable() {
        // The trapezoidal rule at 2 ms errs by about (w dt)^2 / 12 = 1.6e-5.
        assert!((printed_sign() + 1.0).abs() < 1e-4, "{}", printed_sign());
    }
}
