//! The physics of rolling: pure formulas, no input or output, no randomness.

pub mod cross_modes;
pub mod damping;
pub mod equation;
pub mod exciting_moment;
pub mod response;
pub mod wall_waves;
