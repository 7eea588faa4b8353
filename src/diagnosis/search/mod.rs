//! The search for causes.
//!
//! `score` weighs every effect in one pass, `trial` fits the best in full as far as
//! they matter, `plausible` holds them to their physical ranges, `entry` judges whether
//! the first of them enters, `growth` lets one after the other in, and `backward` looks back.

pub(super) mod alike;
mod backward;
pub(super) mod entered;
pub(super) mod entry;
pub(super) mod growth;
mod onset;
mod plausible;
mod reseated;
pub(super) mod score;
pub(super) mod stem;
pub(super) mod trial;
