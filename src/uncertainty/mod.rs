//! What repeats and instruments leave unsure of the damping, and which conditions differ.
//!
//! Everything is told of `b_eq`: repeats of free decays at the amplitude at which runs are
//! compared, their comparison at several, how far it rises between two at each speed, and the
//! budget there of decays and of forced runs.

mod budget;
mod comparison;
mod repeats;
mod rise;
mod slopes;

pub use budget::{Budget, EQUATIONS, budgets};
pub use comparison::{Basis, Comparison, comparisons};
pub use repeats::{Repeats, repeats};
pub use rise::{Rise, rises};

/// Roll amplitudes of budget and comparison [deg]: of those that every run reports, the small, the
/// usual, the large.
const AMPLITUDES_DEG: [f64; 4] = [2.0, 5.0, 10.0, 15.0];
