//! Stories of instruments: what their lines carry, and what comes of it.

mod a_cable_is_pulled_and_put_back;
mod a_late_answer_is_nobodys;
mod a_reader_is_not_kept_waiting;
mod a_reader_that_fails_comes_back;
mod a_replay_gives_the_live_samples_to_the_bit;
mod a_slow_reader_loses_nothing;
mod a_wrong_setup_is_told_with_its_remedy;
mod any_bytes_are_survived;
mod bench;
mod clocks_are_known_within_their_bound;
#[path = "../../tests/debian.rs"]
mod debian;
mod every_driver_reads_its_instrument;
mod every_emulator_obeys_its_faults;
mod fast_samples_are_read_without_a_loss;
mod pymodbus_answers_our_requests;
mod samples_without_a_number_are_missed;
mod the_reference_sketch_is_read;
mod two_share_an_address;
mod who_answers_is_asked;
mod wire;
