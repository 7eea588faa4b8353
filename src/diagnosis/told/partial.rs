//! Effects that take a part of what was left when they entered, and leave most of it.

use crate::diagnosis::fit::leftover::{Leftover, sure_share};
use crate::diagnosis::search::entered::Entered;

/// Share of what was left before beyond which causes are no whole story; by trial on simulated
/// campaigns.
const MOST_LEFT: f64 = 0.1;

/// Share of the motion of a channel beyond which nothing is explained, whatever was left [-]; by
/// judgement, against fits that ran away and were best all the same.
const MOST_OF_MOTION: f64 = 0.2;

/// Whether causes leave too much of what they found: of what was left in the band of the roll, or
/// of all that they took away, be it a ringing far above it.
pub(super) fn is_part(before: &[Leftover], after: &[Leftover], untold: &[Leftover]) -> bool {
    let taken = before.iter().zip(after).map(|(before, after)| {
        (before.rms.powi(2) - after.rms.powi(2)) / before.motion_rms.powi(2).max(1e-30)
    });
    let found = sure_share(before).max(taken.sum());
    let mut sure = untold.iter().filter(|left| left.is_sure()).peekable();
    let is_sure = sure.peek().is_some();
    let is_most = sure.any(|left| left.share > MOST_OF_MOTION);
    is_most || (is_sure && sure_share(untold) > MOST_LEFT * found)
}

/// How many of the last effects are only a part of what they found, the first excepted: under all
/// of them together too much of it is left for sure.
pub(super) fn n_parts(entered: &[Entered], left: &[Leftover]) -> usize {
    if !left.iter().any(Leftover::is_sure) {
        return 0;
    }
    let share = sure_share(left);
    let others = entered.iter().skip(1).rev();
    let is_part = |effect: &&Entered| effect.found.is_some_and(|of| share > MOST_LEFT * of);
    others.take_while(is_part).count()
}
