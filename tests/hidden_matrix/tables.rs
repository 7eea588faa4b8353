//! The page of tables.

use serde_json::Value;

/// The page.
pub(crate) fn page(outcomes: &[Value]) -> String {
    format!("# Hidden effects\n\n{} campaigns.\n", outcomes.len())
}
