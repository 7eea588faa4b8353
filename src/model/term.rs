//! Numbers of the base equation and of the effects that act in one run.

use super::effect::Effect;

/// The base equation of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// Natural frequency [rad/s].
    pub natural_rad_s: f64,
    /// Linear damping [1/s].
    pub b1_per_s: f64,
    /// Cubic damping [s].
    pub b3_s: f64,
    /// Logarithm of the measured moment's scale: restoring, arm and gains together [-].
    pub log_scale: f64,
}

/// One effect with its numbers in one run.
#[derive(Debug, Clone)]
pub struct Term {
    /// The effect.
    pub effect: &'static Effect,
    /// Strengths, then shapes.
    pub values: Vec<f64>,
}
