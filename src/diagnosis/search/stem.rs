//! A model that is known from other records of the same runs, from which another grows.

use super::entered::Entered;
use crate::diagnosis::fit::leftover::{excess, leftovers, sure_share};
use crate::diagnosis::fit::run_fit::ChannelNoise;
use crate::diagnosis::fit::settle::{Settled, settle};
use crate::diagnosis::fit::survey::{Fit, Survey};

/// A model and the effects in it.
pub(in crate::diagnosis) struct Stem {
    pub(in crate::diagnosis) fit: Fit,
    pub(in crate::diagnosis) entered: Vec<Entered>,
    pub(in crate::diagnosis) ranking: Vec<(&'static str, f64)>,
}

impl Stem {
    /// The effects with what they explain here, one after the other: what other records say of them
    /// may be of the first periods alone, and what is a crumb of them is judged by it.
    pub(super) fn weighed_anew(
        &self,
        survey: &Survey,
        base_fit: &Fit,
        current: &Settled,
        noise: &[ChannelNoise],
    ) -> Vec<Entered> {
        let mut entered = self.entered.clone();
        let found = sure_share(&leftovers(survey, base_fit));
        let mut before = settle(survey, base_fit.clone(), noise);
        for (e, one) in entered.iter_mut().enumerate() {
            let mut fit = current.fit.clone();
            fit.extensions.truncate(e + 1);
            let after = settle(survey, fit, noise);
            let log = after.log_evidence - before.log_evidence;
            if log > one.log_bayes_factor {
                let left = [&before, &after].map(|of| excess(&leftovers(survey, &of.fit)));
                (one.log_bayes_factor, one.removed) = (log, left[0] - left[1]);
            }
            tracing::debug!(effect = one.id, log = one.log_bayes_factor, "known of other records");
            if let Some(of) = &mut one.found {
                *of = found;
            }
            before = after;
        }
        entered
    }
}
