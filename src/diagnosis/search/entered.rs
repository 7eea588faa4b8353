//! One effect in the model with what cannot be told from it.

/// Least logarithm of a Bayes factor at which an effect may enter: one in a thousand by chance.
pub(super) const ENTERS: f64 = 7.0;

/// One effect in the model with what cannot be told from it.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Entered {
    pub(in crate::diagnosis) id: &'static str,
    pub(in crate::diagnosis) log_bayes_factor: f64,
    /// What it removes of what is left beyond the noise, in units of its variance.
    pub(super) removed: f64,
    /// Sum over channels of the shares that were left for sure before it entered [-]; none where
    /// it only makes the runs agree better.
    pub(in crate::diagnosis) found: Option<f64>,
    pub(in crate::diagnosis) equivalent_to: Vec<&'static str>,
}
