//! What closing a run takes, and where it is told.

use super::Event;
use super::Limits;
use super::RunEnd;
use super::RunKind;
use super::aftermath::Following;
use super::assembly::Stretch;
use super::forced::Cycle;
use super::half_cycles::QUIET_MIN_S;
use super::records::Records;

/// The channels, the limits, and whoever is told.
pub(super) struct Closer<'a> {
    pub(super) records: &'a Records,
    pub(super) limits: &'a Limits,
    pub(super) events: &'a mut Vec<Event>,
    /// What the model does after its last release.
    pub(super) following: &'a mut Option<Following>,
}

impl Closer<'_> {
    /// Tells the run that a stretch makes, or why it makes none; what comes after a decay is
    /// followed, unless it is part of what came after an earlier release.
    pub(super) fn tell(&mut self, stretch: &Stretch<'_>) {
        let event = stretch.close(self.records, self.limits);
        if let Event::Run(run) = &event
            && run.kind == RunKind::Decay
            && self.following.is_none_or(|following| following.is_begun_by(run))
        {
            let is_left_alone =
                matches!(run.end, RunEnd::LostInNoise | RunEnd::Caught | RunEnd::ReStruck);
            let behind = || Following::behind(stretch.used(), run.end_s);
            *self.following = is_left_alone.then(behind).flatten();
        }
        self.events.push(event);
    }

    /// Follows the model through its next half cycle, which may begin with its release.
    pub(super) fn follow(&mut self, cycle: &Cycle) {
        let ripple = self.records.ripple();
        if self.following.as_mut().is_some_and(|following| !following.goes_on(cycle, ripple)) {
            self.leave();
        }
        if self.following.is_none() {
            *self.following = Following::released(cycle, self.records);
        }
    }

    /// The model has been still up to `at_s`: waves may come back from the walls yet, and a hand
    /// that holds it at heel ends what is followed.
    pub(super) fn rest(&mut self, at_s: f64) {
        let roll_rad = self.records.roll.mean(at_s - QUIET_MIN_S, at_s);
        let rests = |following: Following| roll_rad.is_some_and(|roll| following.rests_at(roll));
        if self.following.is_some_and(|following| !rests(following)) {
            self.leave();
        }
    }

    /// Follows no further.
    pub(super) fn leave(&mut self) {
        let followed = self.following.take().and_then(|following| following.close(self.records));
        self.events.extend(followed.map(Event::Aftermath));
    }
}
