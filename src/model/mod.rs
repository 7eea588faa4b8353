//! The simulation model as data: the base equation, and one table of effects that may extend it.
//!
//! `(1 + i) phi'' + b1 phi' + b3 phi'^3 + w^2 phi = M/I + u`: each effect adds to the moment `u`,
//! to the inertia `i`, or to what an instrument reads. An effect is one file in `effects/` and one
//! line of the table there; nothing else knows its name.

pub mod course;
pub mod echo;
pub mod effect;
pub mod effects;
pub mod free;
pub mod history;
pub mod imposed;
pub mod lead;
pub mod model_file;
pub mod number;
pub mod term;

mod channel;
mod free_changes;
mod imposed_changes;
mod lagging;
mod linear;
mod slopes;
mod smoothed;

pub use effect::{
    Acts, Circumstances, Clip, Effect, Facts, Instant, Layer, Line, Parameter, Recurs, Scope, Seen,
    UNDER_WAY_FROUDE,
};
pub use term::{Base, Columns, N_BASE, Term};
