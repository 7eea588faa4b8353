//! What the simulation gets wrong: shown, named, mended, and the gain measured.
//!
//! All runs of a campaign are fitted together by the base model. One pass of sensitivities scores
//! every effect of the table (`score`); the best are fitted in full (`settle`) and weighed by
//! their evidence, so that the model grows by one effect at a time (`growth`) until nothing more
//! is to be named.

mod added;
mod alike;
mod backward;
mod clipping;
mod cores;
mod correction;
mod cost;
mod elimination;
mod entry;
mod facts;
mod foretold;
mod gain;
mod growth;
mod known;
mod layout;
mod leftover;
mod next_run;
mod observation;
mod onset;
mod over_scatters;
mod partial;
mod plan;
mod records;
mod repeating;
mod reseated;
mod reversed;
mod run_fit;
mod scatter;
mod score;
mod settle;
mod shaking;
mod shared_line;
mod solve;
mod spectrum;
mod survey;
mod trial;
mod unexplained;
mod verdict;
mod wavering;
mod whole;

pub use correction::{Corrected, corrected};
pub use leftover::Leftover;
pub use next_run::{NextRun, PlannedRun};
pub use observation::Observation;
pub use reversed::Reversed;
pub use unexplained::Unexplained;
pub use verdict::{Bias, Cause, Change, Diagnosis, Gain, Verdict};
pub use whole::{Gathered, diagnose};
