//! The paper that the method comes from: its tables, with its figures computed again.
