//! Stories.
#![expect(clippy::print_stdout, reason = "a failing story shows what it saw")]

mod run_finding_any_stream;
mod run_finding_decays;
mod run_finding_false_alarms;
mod run_finding_forced;
mod run_finding_kvlcc2;
mod run_finding_paper;
mod run_finding_scene;
mod the_simulated_tank_keeps_its_script;
mod the_simulated_tank_writes_campaigns;
