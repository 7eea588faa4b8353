//! Stories.

mod the_simulated_tank_keeps_its_script;
mod the_simulated_tank_writes_campaigns;
