//! The joint fit of all runs by one model.
//!
//! `survey` holds the runs and what is fitted to them; `run_fit` simulates one run with its
//! sensitivities, `elimination` takes out what is the run's own, `solve` puts the runs together by
//! the columns of `layout`, and `settle` steps until nothing moves. `leftover` says what stays.

pub(super) mod added;
pub(super) mod cores;
pub(super) mod cost;
pub(super) mod elimination;
pub(super) mod layout;
pub(super) mod leftover;
#[cfg(test)]
pub(super) mod long_decay;
mod over_scatters;
pub(super) mod run_fit;
pub(super) mod scatter;
pub(super) mod settle;
pub(super) mod solve;
pub(super) mod survey;
