//! A simulated towing tank that hides effects, independent of the program that must find them.
//!
//! Its equations, integrator (Gauss and Legendre, implicit, order four) and instruments are stated
//! here anew; nothing below names a module of `rolltank`. A mistake of the program about physics is
//! therefore not repeated by what tests it. The chain of one campaign:
//!
//! `plan` (what is towed) -> `effect` (what hides) -> `motion` (what the model does) ->
//! `instruments` (what the transducers make of it) -> `folder` (what the user has, and the truth).

pub(crate) mod base;
pub(crate) mod campaign;
pub(crate) mod draw;
pub(crate) mod effect;
pub(crate) mod effects;
pub(crate) mod fit;
pub(crate) mod folder;
pub(crate) mod foretold;
pub(crate) mod instruments;
pub(crate) mod integrate;
pub(crate) mod learnt;
mod least_squares;
pub(crate) mod motion;
pub(crate) mod next_run;
pub(crate) mod plan;
pub(crate) mod score;
pub(crate) mod timeline;
pub(crate) mod verdict;
