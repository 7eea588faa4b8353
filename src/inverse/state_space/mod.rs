//! The exact posterior of a moment history, in time proportional to the record.
//!
//! [`transition`] says how roll and moment move together, [`filter`] whitens a record under it,
//! [`smoother`] runs back, [`posterior`] integrates over smoothness and noise, and [`history`]
//! turns the states into the moment `U` with its band.

pub mod coloured;
pub mod damped;
pub mod drifting;
pub mod filter;
pub mod history;
pub mod matern;
pub mod matrix;
pub mod posterior;
pub mod smoother;
pub mod transition;
pub mod triangle;
