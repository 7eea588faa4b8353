//! What to tow next: `plan` lists the runs that the tank allows, `foretold` says what each would
//! bring, `couples` what two would, `most_telling` chooses.

mod couples;
mod foretold;
mod known;
pub(super) mod most_telling;
pub(super) mod plan;
