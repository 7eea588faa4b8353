//! What repeats and instruments leave unsure of the damping, and which conditions differ.
//!
//! Everything is told of `b_eq` at the amplitude at which runs are compared, from free decays.

mod budget;
mod comparison;
mod repeats;

pub use budget::{Budget, EQUATIONS, budgets};
pub use comparison::{Basis, Comparison, comparisons};
pub use repeats::{Repeats, repeats};
