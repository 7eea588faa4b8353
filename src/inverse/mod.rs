//! The inverse problem: from a run's record to its damping, with credible bands.

pub mod estimate;
pub mod identification;
pub mod paper;
