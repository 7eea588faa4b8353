//! What the simulation gets wrong: shown, named, mended, and the gain measured.
//!
//! All runs of a campaign are fitted together by the base model. One pass of sensitivities scores
//! every effect of the table (`score`); the best are fitted in full (`settle`) and weighed by
//! their evidence, so that the model grows by one effect at a time (`growth`) until nothing more
//! is to be named.

mod elimination;
mod facts;
mod growth;
mod observation;
mod run_fit;
mod score;
mod settle;
mod solve;
mod survey;
mod verdict;

pub use observation::Observation;
pub use verdict::{Cause, Diagnosis, Verdict, diagnose};
