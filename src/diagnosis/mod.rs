//! What the simulation gets wrong: shown, named, mended, and the gain measured.
//!
//! Every run is seen as an observation (`record`), and all runs of a campaign are fitted together
//! by the base model (`fit`). One pass of sensitivities scores every effect of the table; the best
//! are fitted in full and weighed by their evidence, so that the model grows by one effect at a
//! time (`search`) until nothing more is to be named. Then it is said which run would say most
//! (`next_run`), and everything is put into words and figures (`told`). Each folder uses those
//! before it alone, and no file in it is used by one that it uses.

mod cause;
mod correction;
mod fit;
mod next_run;
mod record;
mod search;
mod shaking;
mod shown;
mod told;
mod whole;

pub use cause::Cause;
pub use correction::{Corrected, corrected};
pub use fit::leftover::Leftover;
pub use next_run::most_telling::NextRun;
pub use next_run::plan::PlannedRun;
pub use record::observation::Observation;
pub use record::reversed::Reversed;
pub use told::bias::Bias;
pub use told::change::Change;
pub use told::diagnosis::Diagnosis;
pub use told::gain::Gain;
pub use told::unexplained::Unexplained;
pub use told::verdict::Verdict;
pub use whole::{Gathered, diagnose};
