//! Rod force to roll exciting moment through the moment arm.

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
