//! A figure before and after the model was extended.

use crate::inverse::estimate::Estimate;

/// A figure before and after the extension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Under the base model.
    pub before: Estimate,
    /// Under the extended model.
    pub after: Estimate,
}
