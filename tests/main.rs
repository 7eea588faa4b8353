//! Stories.

mod architecture;
mod bad_input;
mod campaign_folder;
mod dense_posterior;
mod run_finding_kvlcc2;
mod sampler_cases;
mod sampler_draws_the_exact_posterior;
mod sampler_says_what_it_did;
mod the_command_line;
mod the_simulated_tank_keeps_its_script;
mod the_simulated_tank_writes_campaigns;
