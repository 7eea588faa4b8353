//! Rod force to roll exciting moment through the moment arm.
//!
//! Sign convention: roll is positive starboard down, and a positive exciting moment rolls the model
//! to positive roll. A rod that feeds a damped model therefore does positive work over each cycle,
//! which is how a reversed load cell is noticed.

/// The oscillator rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exciter {
    /// Moment arm `l` [m]: distance from the roll axis to the rod's pin joint.
    pub moment_arm_m: f64,
    /// How the arm depends on the roll angle.
    pub arm: Arm,
    /// Sign of the recorded force: `1.0` when a positive force rolls the model to positive roll.
    pub force_sign: f64,
}

/// How the moment arm depends on the roll angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arm {
    /// `M = F l`, as the paper does.
    Constant,
    /// `M = F l cos(phi)`: the rod stays vertical, as a long rod does.
    Cosine,
    /// The rod of this length [m] tilts as its pin joint moves sideways with the roll.
    Rod {
        /// Length of the rod [m] between its joints.
        rod_length_m: f64,
    },
}

impl Exciter {
    /// Exciting moment [N m] of a rod force [N] along the rod, at a roll angle [rad].
    ///
    /// The pin joint stands at `(l cos phi, l sin phi)` from the roll axis and the rod hangs from a
    /// joint `rod_length_m` above its place at rest, so that the rod leans by `delta` with
    /// `sin delta = l (1 - cos phi) / rod_length_m` and the arm is `l cos(phi + delta)`.
    pub fn moment_n_m(&self, force_n: f64, roll_rad: f64) -> f64 {
        let arm_m = match self.arm {
            Arm::Constant => self.moment_arm_m,
            Arm::Cosine => self.moment_arm_m * roll_rad.cos(),
            Arm::Rod { rod_length_m } => {
                let aside_m = self.moment_arm_m * (1.0 - roll_rad.cos());
                let lean_rad = (aside_m / rod_length_m).clamp(-1.0, 1.0).asin();
                self.moment_arm_m * (roll_rad + lean_rad).cos()
            }
        };
        self.force_sign * force_n * arm_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exciter(arm: Arm) -> Exciter {
        Exciter { moment_arm_m: 0.43, arm, force_sign: 1.0 }
    }

    #[test]
    fn a_long_rod_has_the_cosine_arm_and_a_level_model_the_constant_one() {
        let long = exciter(Arm::Rod { rod_length_m: 1e6 });
        let cosine = exciter(Arm::Cosine);
        assert!((long.moment_n_m(3.0, 0.2) - cosine.moment_n_m(3.0, 0.2)).abs() < 1e-6);
        for arm in [Arm::Constant, Arm::Cosine, Arm::Rod { rod_length_m: 0.5 }] {
            assert!((exciter(arm).moment_n_m(3.0, 0.0) - 1.29).abs() < 1e-12);
        }
    }

    #[test]
    fn ten_degrees_shorten_the_arm_by_one_and_a_half_per_cent() {
        let moment = exciter(Arm::Cosine).moment_n_m(1.0, 10_f64.to_radians());
        assert!((1.0 - moment / 0.43 - 0.0152).abs() < 1e-4);
    }
}
