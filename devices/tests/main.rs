//! Stories of instruments: what their lines carry, and what comes of it.
