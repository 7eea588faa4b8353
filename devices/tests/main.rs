//! Stories of instruments: what their lines carry, and what comes of it.

mod a_cable_is_pulled_and_put_back;
mod any_bytes_are_survived;
mod bench;
mod clocks_are_known_within_their_bound;
mod every_driver_reads_its_instrument;
mod wire;
