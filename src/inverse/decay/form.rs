//! The forms of damping law that are weighed against each other.

use super::curve::{N_CURVE, Scale};

/// A form of damping law: a line, a plane or a smooth curve in the space of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Its equation, as the field writes it.
    pub equation: &'static str,
    /// The powers of the rate it is made of; none for a free curve.
    pub powers: &'static [u8],
    /// Size of a free curve's higher coefficients [-]; nil for a form of powers.
    pub freedom: f64,
    /// Share of the belief that it has before the record is seen.
    pub share: f64,
}

/// Position in [`FORMS`] of the law of Sec. 4.1, of which the coefficients are reported.
pub const CUBIC: usize = 0;

/// Every form; the last ones are one form, a free curve, at three sizes of its freedom.
pub const FORMS: [Form; 6] = [
    Form { equation: "b1 phi' + b3 phi'^3", powers: &[1, 3], freedom: 0.0, share: 0.25 },
    Form { equation: "b1 phi' + b2 phi'|phi'|", powers: &[1, 2], freedom: 0.0, share: 0.25 },
    Form {
        equation: "b1 phi' + b2 phi'|phi'| + b3 phi'^3",
        powers: &[1, 2, 3],
        freedom: 0.0,
        share: 0.25,
    },
    Form { equation: "a smooth odd curve", powers: &[], freedom: 0.1, share: 1.0 / 12.0 },
    Form { equation: "a smooth odd curve", powers: &[], freedom: 0.3, share: 1.0 / 12.0 },
    Form { equation: "a smooth odd curve", powers: &[], freedom: 1.0, share: 1.0 / 12.0 },
];

/// Prior standard deviation of every coefficient at the size of the run's damping [-]: the law may
/// well be twice as large as it looks, in either part.
const PRIOR_SD: f64 = 2.0;

/// One direction of a form in the space of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Curve coefficients of one unit.
    pub curve: [f64; N_CURVE],
    /// Prior standard deviation of that unit [-].
    pub prior_sd: f64,
}

impl Form {
    /// The directions that the form spans.
    pub fn directions(&self) -> Vec<Direction> {
        let of_power = |power: &u8| Direction { curve: power_curve(*power), prior_sd: PRIOR_SD };
        if !self.powers.is_empty() {
            return self.powers.iter().map(of_power).collect();
        }
        (0..N_CURVE)
            .map(|k| {
                let mut curve = [0.0; N_CURVE];
                curve[k] = 1.0;
                // A straight line is free; what bends it falls off as the derivatives of a curve
                // that is smooth on the scale of the run.
                let bent = self.freedom / (k * k).max(1) as f64;
                Direction { curve, prior_sd: if k < 2 { PRIOR_SD } else { bent } }
            })
            .collect()
    }

    /// What one unit of a direction is in the coefficient's own unit, `1/s`, `1`, `s`.
    pub fn unit(&self, direction: usize, scale: &Scale) -> f64 {
        let power = i32::from(self.powers[direction]);
        scale.damping_per_s / scale.rate_rad_per_s.powi(power - 1)
    }
}

/// Curve coefficients of `phi' |phi'/R|^(power - 1)`.
pub(super) fn power_curve(power: u8) -> [f64; N_CURVE] {
    match power {
        1 => [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        2 => [0.5, 0.5, 0.0, 0.0, 0.0, 0.0],
        _ => [1.0 / 3.0, 0.5, 1.0 / 6.0, 0.0, 0.0, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shares_sum_to_one() {
        assert!((FORMS.iter().map(|f| f.share).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn every_power_is_what_its_curve_says() {
        let scale = Scale { damping_per_s: 0.4, rate_rad_per_s: 1.5 };
        for form in FORMS {
            for (direction, (d, power)) in form.directions().iter().zip(form.powers).enumerate() {
                for rate in [-1.2_f64, 0.3, 1.5] {
                    let curve: f64 =
                        scale.moments(rate).iter().zip(d.curve).map(|(m, c)| m * c).sum();
                    let law = form.unit(direction, &scale)
                        * rate
                        * rate.abs().powi(i32::from(*power) - 1);
                    assert!((curve - law).abs() < 1e-12, "{} at {rate}", form.equation);
                }
            }
        }
    }
}
