//! The commands of `rolltank`, one file each.
