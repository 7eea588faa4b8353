//! One effect that is told, with its numbers and what these runs cannot tell from it.

use crate::inverse::estimate::Estimate;

/// One effect of the extended model.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The effect.
    pub effect: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Logarithm of the Bayes factor for adding it [-].
    pub log_bayes_factor: f64,
    /// Parameters: symbol, unit, estimate; the runs or conditions one after the other.
    pub parameters: Vec<(&'static str, &'static str, Estimate)>,
    /// Effects that these runs cannot part from it.
    pub equivalent_to: Vec<&'static str>,
}
