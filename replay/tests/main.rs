//! Stories of recordings: what a tank's files look like, and what comes out of them.

mod any_bytes_never_panic;
mod bad_tables_are_told_with_their_place;
mod channels_with_their_own_time_bases_are_merged;
mod foreign_mcap_recordings_are_read_by_topic_and_field;
mod measured_recordings_are_read;
mod memory_stays_bounded_on_long_recordings;
mod our_recordings_come_back_to_the_bit;
mod protobuf_recordings_are_read_by_their_own_descriptor;
mod python;
mod python_and_we_read_each_other;
mod recordings;
mod recordings_are_listed_and_never_overwritten;
mod tables_of_any_style_are_read;
mod time_stamps_are_kept_or_mended;
mod torn_recordings_are_read_up_to_the_tear;
