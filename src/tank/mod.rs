//! The simulated tank: a scenario goes in, recordings and their sealed truth come out.
//!
//! It shares no equation with the identifier: `equation` has its own equation of motion and its
//! own integrator, and what comes out has passed the whole instrument chain, so a mistake in one
//! shows in the other.

mod action;
mod carriage;
mod check;
mod check_pass;
mod equation;
mod excitation;
mod folder;
mod free_roll;
mod imposed;
mod instruments;
mod motion;
pub mod paper;
mod parse;
mod readings;
mod scenario;
mod sensing;
mod simulate;
mod table;
mod truth;
mod witness;

pub use action::Action;
pub use folder::{TankError, campaign_head, truth_path, write_campaign};
pub use free_roll::FreeRoll;
pub use instruments::{FileFormat, Instrument, Instruments, RecordingFormat, RollUnit};
pub use parse::ScenarioError;
pub use readings::Readings;
pub use scenario::{
    ArmShape, Basin, CarriagePlan, Condition, Damping, DampingLaw, DampingRow, Gap, Pass, Scenario,
    Shaker, Vibration, Waves, Zeros,
};
pub use simulate::{SimulatedPass, simulate_pass};
pub use truth::{
    CampaignTruth, PassTruth, RejectedKind, TrueEnd, TrueKind, TrueRejection, TrueRun,
};
