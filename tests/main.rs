//! Stories.

mod json_schema;
mod synthetic_results;
mod synthetic_roll;
mod the_json_contract_holds;
mod the_report_is_complete_and_self_contained;
mod the_tables_and_the_catalogue_agree_with_the_results;
