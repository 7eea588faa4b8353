//! Stories.
#![expect(clippy::print_stdout, reason = "a failing story shows what it saw")]

mod architecture;
mod bad_input;
mod campaign_folder;
mod dense_posterior;
mod json_schema;
mod kvlcc2_is_identified_as_published;
mod run_finding_any_stream;
mod run_finding_decays;
mod run_finding_false_alarms;
mod run_finding_forced;
mod run_finding_kvlcc2;
mod run_finding_scene;
mod sampler_cases;
mod sampler_draws_the_exact_posterior;
mod sampler_says_what_it_did;
mod synthetic_results;
mod synthetic_roll;
mod the_command_line;
mod the_exact_posterior_is_the_dense_one;
mod the_json_contract_holds;
mod the_paper_campaign_is_covered;
mod the_report_is_complete_and_self_contained;
mod the_simulated_tank_keeps_its_script;
mod the_simulated_tank_writes_campaigns;
mod the_tables_and_the_catalogue_agree_with_the_results;
