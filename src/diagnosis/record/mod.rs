//! One run as the diagnosis sees it: an `observation`, and what its record shows without a model.

mod clipping;
pub(super) mod facts;
mod noise;
pub(super) mod observation;
mod repeating;
pub(super) mod reversed;
pub(super) mod shared_line;
pub(super) mod spectrum;
pub(super) mod wavering;
