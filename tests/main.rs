//! Stories.

mod run_finding_kvlcc2;
