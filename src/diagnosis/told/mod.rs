//! What is told of a campaign: the verdict, the gain, the bias, the moment that stays unexplained.

pub(super) mod bias;
pub(super) mod change;
pub(super) mod diagnosis;
pub(super) mod gain;
mod partial;
pub(super) mod unexplained;
pub(super) mod verdict;
