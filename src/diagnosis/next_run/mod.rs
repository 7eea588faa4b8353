//! What to tow next: `plan` lists the runs that the tank allows, `foretold` says what each would
//! bring, `most_telling` chooses.

mod foretold;
mod known;
pub(super) mod most_telling;
pub(super) mod plan;
