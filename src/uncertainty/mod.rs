//! What repeats and instruments leave unsure of the damping, and which conditions differ.
//!
//! Everything is told of `b_eq` from free decays: repeats at the amplitude at which runs are
//! compared, the budget and the comparison at several.

mod budget;
mod comparison;
mod repeats;

pub use budget::{Budget, EQUATIONS, budgets};
pub use comparison::{Basis, Comparison, comparisons};
pub use repeats::{Repeats, repeats};

/// Roll amplitudes of budget and comparison [deg]: of those that every run reports, the small, the
/// usual, the large.
const AMPLITUDES_DEG: [f64; 4] = [2.0, 5.0, 10.0, 15.0];
