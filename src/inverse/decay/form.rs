//! The forms of damping law that are weighed against each other.

use super::curve::{N_CURVE, Scale};

/// What a form of damping law is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A sum of whole powers of the rate.
    Powers(&'static [u8]),
    /// One power near this one, any real number.
    PowerNear(f64),
    /// Any smooth odd curve, its bends of this size [-].
    Curve(f64),
}

/// A form of damping law: a line, a plane or a smooth curve in the space of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// Its equation, as the field writes it.
    pub equation: &'static str,
    /// What it is made of.
    pub shape: Shape,
    /// Share of the belief that it has before the record is seen.
    pub share: f64,
}

/// Position in [`FORMS`] of the law of Sec. 4.1, of which the coefficients are reported.
pub const CUBIC: usize = 0;

const POWER_LAW: &str = "b phi'|phi'|^(p-1)";
const FREE_CURVE: &str = "a smooth odd curve";

/// Every form; lines of one equation are one form, at nodes of what its shape holds.
pub const FORMS: [Form; 13] = [
    Form { equation: "b1 phi' + b3 phi'^3", shape: Shape::Powers(&[1, 3]), share: 0.2 },
    Form { equation: "b1 phi' + b2 phi'|phi'|", shape: Shape::Powers(&[1, 2]), share: 0.2 },
    Form {
        equation: "b1 phi' + b2 phi'|phi'| + b3 phi'^3",
        shape: Shape::Powers(&[1, 2, 3]),
        share: 0.2,
    },
    power_near(1.25),
    power_near(1.5),
    power_near(1.75),
    power_near(2.0),
    power_near(2.25),
    power_near(2.5),
    power_near(2.75),
    curve(0.1),
    curve(0.3),
    curve(1.0),
];

/// Half of the distance between the powers above, which each line stands for on both sides.
const POWER_REACH: f64 = 0.125;

const fn power_near(power: f64) -> Form {
    Form { equation: POWER_LAW, shape: Shape::PowerNear(power), share: 0.2 / 7.0 }
}

const fn curve(freedom: f64) -> Form {
    Form { equation: FREE_CURVE, shape: Shape::Curve(freedom), share: 0.2 / 3.0 }
}

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
        match self.shape {
            Shape::Powers(powers) => powers
                .iter()
                .map(|power| Direction {
                    curve: power_curve(f64::from(*power)),
                    prior_sd: PRIOR_SD,
                })
                .collect(),
            Shape::PowerNear(power) => vec![
                Direction { curve: power_curve(power), prior_sd: PRIOR_SD },
                // What a change of the power does, for a law of the run's own size.
                Direction { curve: power_slope(power), prior_sd: POWER_REACH },
            ],
            Shape::Curve(freedom) => (0..N_CURVE)
                .map(|k| {
                    let mut curve = [0.0; N_CURVE];
                    curve[k] = 1.0;
                    // A straight line is free; what bends it falls off as the derivatives of a
                    // curve that is smooth on the scale of the run.
                    let bent = freedom / (k * k).max(1) as f64;
                    Direction { curve, prior_sd: if k < 2 { PRIOR_SD } else { bent } }
                })
                .collect(),
        }
    }

    /// The whole powers that the roll equation is fitted with where this form is favoured.
    pub fn powers(&self) -> &'static [u8] {
        match self.shape {
            Shape::Powers(powers) => powers,
            Shape::PowerNear(_) | Shape::Curve(_) => &[1, 2, 3],
        }
    }
}

/// What one unit of a power's direction is in the coefficient's own unit, `s^(power - 2)`.
pub fn power_unit(power: f64, scale: &Scale) -> f64 {
    scale.damping_per_s / scale.rate_rad_per_s.powf(power - 1.0)
}

/// Curve coefficients of `phi' |phi'/R|^(power - 1)`:
/// `(2k+1) a (a-1) .. (a-k+1) / ((a+1) .. (a+k+1))` with `a = power - 1`.
pub fn power_curve(power: f64) -> [f64; N_CURVE] {
    let a = power - 1.0;
    let mut product = 1.0 / (a + 1.0);
    std::array::from_fn(|k| {
        let order = k as f64;
        let coefficient = (2.0 * order + 1.0) * product;
        product *= (a - order) / (a + order + 2.0);
        coefficient
    })
}

/// Derivative of [`power_curve`] by the power.
fn power_slope(power: f64) -> [f64; N_CURVE] {
    const STEP: f64 = 1e-5;
    let (above, below) = (power_curve(power + STEP), power_curve(power - STEP));
    std::array::from_fn(|k| (above[k] - below[k]) / (2.0 * STEP))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shares_sum_to_one() {
        assert!((FORMS.iter().map(|f| f.share).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    /// Moment [rad/s2] of a direction's unit at a rate, over what its power says.
    fn misses(power: f64, rate: f64) -> f64 {
        let scale = Scale { damping_per_s: 0.4, rate_rad_per_s: 1.5 };
        let curve: f64 =
            scale.moments(rate).iter().zip(power_curve(power)).map(|(m, c)| m * c).sum();
        let law = power_unit(power, &scale) * rate * rate.abs().powf(power - 1.0);
        (curve - law).abs() / (0.4 * 1.5)
    }

    #[test]
    fn whole_powers_are_exact_and_others_close() {
        for rate in [-1.2, 0.3, 1.5] {
            for power in [1.0, 2.0, 3.0] {
                assert!(misses(power, rate) < 1e-12, "{power} at {rate}");
            }
            for power in [1.5, 1.85, 2.4] {
                assert!(misses(power, rate) < 1e-2, "{power} at {rate}: {}", misses(power, rate));
            }
        }
    }
}
