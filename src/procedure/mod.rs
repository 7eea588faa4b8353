//! What the ITTC procedure 7.5-02-07-04.5 asks of a roll test, answered from what was recorded.
//!
//! Each gate is advice: a run that misses one is identified and reported like any other, and the
//! answer says by how much it was missed. Where the procedure names no number, the limit is ours
//! and the gate says so.

mod campaign_gates;
mod gate;
mod run_gates;

pub use campaign_gates::{CampaignAnswer, of_campaign};
pub use gate::{Answer, Gate};
pub use run_gates::{CALM_DEG, of_run};
