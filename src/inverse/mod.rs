//! The inverse problem: from a run's record to its damping, with credible bands.

pub mod decay_fit;
pub mod estimate;
pub mod filter;
pub mod forced;
pub mod half_cycles;
pub mod harmonic;
pub mod identification;
pub mod matrix;
pub mod mixture;
pub mod moment_history;
pub mod moment_posterior;
pub mod paper;
pub mod record;
pub mod smoother;
pub mod transition;
