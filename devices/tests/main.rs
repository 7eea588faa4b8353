//! Stories of instruments: what their lines carry, and what comes of it.

mod clocks_are_known_within_their_bound;
