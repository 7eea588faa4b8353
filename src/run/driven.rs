//! Follows a roll under the rod whose excitation does not repeat.

use super::RunEnd;
use super::RunKind;
use super::assembly::Stretch;
use super::decay::START_RAD;
use super::forced;
use super::forced::Cycle;
use super::harmonic::Harmonic;
use super::records::Records;
use super::ripple::Ripple;
use super::track::Track;
use super::unused::Cause;
use super::unused::Unused;

/// Half cycles that tell inertia from damping whatever their course: twelve periods.
pub(super) const N_HALF_CYCLES_MIN: usize = 24;
/// Half cycles with an excitation of their own after which a rod is at work.
pub(super) const N_OWN: usize = 8;
/// Half cycles without a drive after which the rod is off, not just in a lull.
const N_IDLE: usize = 4;
/// Half cycles that are compared with another excitation at a time.
const N_BLOCK: usize = 4;
/// Half cycles that must be steady before what did not repeat is believed to be over.
const N_SETTLED_BEHIND: usize = 12;
/// Half cycles of a steady roll from which a drift of its frequency is told.
const N_DRIFTING: usize = forced::N_SETTLED;
/// Change of frequency from the first to the second half of a roll that is no steady one [-].
const DRIFT: f64 = 0.002;
/// Difference of the drive from a sine that makes another excitation, as a share of the sine: over
/// four half cycles a frequency that is 6 % off makes as much.
const OTHER_DRIVE: f64 = 0.15;
/// Residual of a drive that only follows the roll, in standard deviations of its bins.
const FOLLOWS: f64 = 2.0;

/// Frequency [rad/s] and size of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Excitation {
    frequency_rad_s: f64,
    size: f64,
}

/// The roll under the rod that no steady run has claimed so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Driven {
    cycles: Vec<Cycle>,
    /// Half cycles at the end without a drive.
    n_idle: usize,
    /// What was unused before it.
    before: Option<Unused>,
    /// The excitation of the steady run just before it.
    beside: Option<Excitation>,
    /// A rod drives it, not the roll's own crosstalk.
    by_rod: bool,
    /// A part of it seemed steady, but its frequency drifts.
    drifts: bool,
}

/// A stretch that has an excitation of its own.
#[derive(Debug)]
pub(super) struct Closed {
    /// Its half cycles.
    pub(super) cycles: Vec<Cycle>,
    /// What was unused before it.
    pub(super) before: Option<Unused>,
}

impl Closed {
    /// When the roll leaves its first turning point [s].
    pub(super) fn start_s(&self) -> f64 {
        self.cycles[0].half.start.left_s
    }

    /// When its last half cycle ends [s].
    pub(super) fn end_s(&self) -> f64 {
        self.cycles[self.cycles.len() - 1].half.end.time_s
    }

    /// Amplitude of its last half cycle [rad].
    pub(super) fn last_amplitude_rad(&self) -> f64 {
        self.cycles[self.cycles.len() - 1].half.amplitude_rad()
    }

    /// What is unused behind it, of which `cycles` are known already.
    pub(super) fn unused_behind(&self, end: RunEnd, cycles: &[Cycle]) -> Unused {
        let end_s = self.end_s();
        let why = format!("{} at {end_s:.1} s", end.clause());
        let mut unused = Unused::new(end_s, Cause::After(end, why));
        unused.extend_by(cycles);
        unused
    }

    /// The stretch as one that ends for the reason `end`.
    pub(super) fn stretch(&self, end: RunEnd) -> Stretch<'_> {
        Stretch {
            kind: RunKind::Forced,
            repeats: false,
            start_s: self.start_s(),
            end_s: self.end_s(),
            end,
            cycles: &self.cycles,
            between_touches: false,
        }
    }
}

impl Driven {
    /// Time [s] from which samples are still needed.
    pub(super) fn needed_from_s(&self) -> Option<f64> {
        self.cycles.first().map(|c| c.half.start.time_s)
    }

    /// Whether a rod has driven the roll for so long that no free decay can be part of it.
    pub(super) fn is_by_rod(&self) -> bool {
        self.by_rod
    }

    /// Why the stretch ends before `cycle`, which cannot be part of it.
    pub(super) fn end_before(cycle: &Cycle) -> RunEnd {
        if cycle.steady { RunEnd::ExcitationChanged } else { RunEnd::PassEnded }
    }

    /// Whether `cycle` can be part of the stretch, which ends otherwise.
    pub(super) fn goes_on(&self, cycle: &Cycle) -> bool {
        self.cycles.is_empty() || cycle.steady && (cycle.is_driven() || self.n_idle < N_IDLE)
    }

    /// Takes a half cycle that no run has claimed.
    pub(super) fn push(&mut self, cycle: &Cycle, unused: Option<&Unused>, records: &Records) {
        if !cycle.steady || (self.cycles.is_empty() && !cycle.is_driven()) {
            return;
        }
        if self.cycles.is_empty() {
            self.before = unused.cloned();
        }
        self.n_idle = if cycle.is_driven() { 0 } else { self.n_idle + 1 };
        self.cycles.push(*cycle);
        if self.cycles.len() == N_OWN {
            self.by_rod = !self.follows_roll(records);
        }
    }

    /// Leaves out what is behind `until_s` [s].
    pub(super) fn cut(&mut self, until_s: f64) {
        self.cycles.retain(|c| c.half.end.time_s <= until_s + 1e-9);
        self.n_idle = 0;
    }

    /// Whether what seemed a run is part of this stretch: a decay under a drive that is soon seen
    /// not to follow it, a steady roll whose frequency drifts or that lasts for too few half
    /// cycles.
    pub(super) fn reclaims(&mut self, seeming: &Stretch, records: &Records, r: Ripple) -> bool {
        let n = seeming.used().len();
        let is_driven = seeming.cycles[..n.max(1)].iter().all(Cycle::is_driven);
        let passing = seeming.end == RunEnd::ExcitationChanged && is_driven;
        match seeming.kind {
            RunKind::Decay => passing && n < N_SETTLED_BEHIND,
            RunKind::Forced => {
                self.drifts |= is_driven && drifts(seeming.used(), records, r);
                self.drifts || passing && seeming.is_too_short()
            }
        }
    }

    /// Takes the half cycles of what seemed to be a run and is none.
    pub(super) fn take_back(&mut self, cycles: &[Cycle], records: &Records) {
        for cycle in cycles {
            self.push(cycle, None, records);
        }
    }

    /// A steady run of `cycles` has ended where the next stretch begins.
    pub(super) fn begin_behind(&mut self, cycles: &[Cycle], records: &Records) {
        *self = Self { beside: excitation(cycles, records), ..Self::default() };
    }

    /// Whether `settled` half cycles at the end of the roll may begin a steady run.
    pub(super) fn yields_to(&self, settled: &[Cycle], records: &Records, ripple: Ripple) -> bool {
        let Some(start_s) = settled.first().map(|c| c.half.start.time_s) else { return false };
        let own = self.n_own(start_s, Some(settled), records);
        let doubtful = self.by_rod && own >= N_OWN || self.drifts;
        !doubtful || settled.len() >= N_SETTLED_BEHIND && !drifts(settled, records, ripple)
    }

    /// Ends the stretch at `until_s` [s] at the latest, where the steady run `next` may follow;
    /// gives it when it has an excitation of its own.
    pub(super) fn close(
        &mut self,
        until_s: f64,
        next: Option<&[Cycle]>,
        records: &Records,
    ) -> Option<Closed> {
        let own = self.n_own(until_s, next, records);
        let is_run = self.by_rod && own >= N_OWN && !self.follows_roll(records);
        self.cycles.truncate(self.cycles.len() - self.n_idle);
        self.cut(until_s);
        if !is_run && next.is_some() {
            // What seems a steady run may yet turn out to be part of it.
            return None;
        }
        let Self { cycles, before, .. } = std::mem::take(self);
        (is_run && cycles.len() >= N_OWN).then_some(Closed { cycles, before })
    }

    /// Number of half cycles before `until_s` that neither the steady run before nor `next` has
    /// the excitation of.
    fn n_own(&self, until_s: f64, next: Option<&[Cycle]>, records: &Records) -> usize {
        let next = next.and_then(|cycles| excitation(cycles, records));
        let n = self.cycles.iter().filter(|c| c.half.end.time_s <= until_s + 1e-9).count();
        let neighbours: Vec<Excitation> = self.beside.into_iter().chain(next).collect();
        let is_own =
            |block: &&[Cycle]| !neighbours.iter().any(|there| there.drives(block, records));
        let large = |c: &&Cycle| c.half.amplitude_rad() >= START_RAD;
        let blocks = self.cycles[..n].chunks(N_BLOCK).filter(is_own);
        blocks.map(|block| block.iter().filter(large).count()).sum()
    }

    /// Whether the drive is nothing but a share of the roll, as crosstalk is.
    fn follows_roll(&self, records: &Records) -> bool {
        let [first, .., last] = self.cycles.as_slice() else { return true };
        let (start_s, end_s) = (first.half.start.time_s, last.half.end.time_s);
        let mut rolls = records.roll.bins(start_s, end_s).peekable();
        let Some(mut before) = rolls.next() else { return true };
        let mut pairs = Vec::new();
        for drive in records.drive.track.bins(start_s, end_s) {
            while let Some(next) = rolls.next_if(|next| next.time_s <= drive.time_s) {
                before = next;
            }
            let Some(after) = rolls.peek() else { break };
            let share = (drive.time_s - before.time_s) / (after.time_s - before.time_s);
            let roll = before.value + share.clamp(0.0, 1.0) * (after.value - before.value);
            pairs.push((roll, drive.value));
        }
        let n = pairs.len().max(1) as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / n;
        let (mean_roll, mean_drive) = (mean(|p| p.0), mean(|p| p.1));
        let (mut rr, mut rd, mut dd) = (0.0, 0.0, 0.0);
        for (roll, drive) in &pairs {
            let (roll, drive) = (roll - mean_roll, drive - mean_drive);
            (rr, rd, dd) = (rr + roll * roll, rd + roll * drive, dd + drive * drive);
        }
        let left = (dd - rd * rd / rr.max(f64::MIN_POSITIVE)).max(0.0) / n;
        left.sqrt() <= FOLLOWS * records.drive.sd()
    }
}

/// Whether the frequency of what seems steady changes from its first half to its second, as roll or
/// drive show it.
fn drifts(cycles: &[Cycle], records: &Records, ripple: Ripple) -> bool {
    let Some(excitation) = excitation(cycles, records) else { return false };
    let (early, late) = cycles.split_at(cycles.len() / 2);
    let on = |track: &Track, noise: f64| {
        let frequency = |half: &[Cycle]| forced::frequency_rad_s(half, track);
        let (Some(early), Some(late)) = (frequency(early), frequency(late)) else { return false };
        // The phase of either half is known to the noise, and so many half cycles lie between.
        (late / early - 1.0).abs() > DRIFT + 2.0 * noise / cycles.len() as f64
    };
    let drive_noise = 2.0 * records.drive.sd() / excitation.size.max(f64::MIN_POSITIVE);
    cycles.len() >= N_DRIFTING
        && (on(&records.roll, ripple.ratio_tolerance(cycles[0].half.amplitude_rad()))
            || on(&records.drive.track, drive_noise))
}

/// The excitation of some half cycles; none where no drive is recorded.
fn excitation(cycles: &[Cycle], records: &Records) -> Option<Excitation> {
    let (first, last) = (cycles.first()?, cycles.last()?);
    let bins = records.drive.track.bins(first.half.start.time_s, last.half.end.time_s);
    let frequency_rad_s = forced::frequency_rad_s(cycles, &records.drive.track)?;
    let size = Harmonic::fit(bins, frequency_rad_s, 0.0)?.amplitude();
    Some(Excitation { frequency_rad_s, size })
}

impl Excitation {
    /// Whether the drive over some half cycles is this one, whatever its phase and whatever the
    /// roll makes of it.
    fn drives(&self, cycles: &[Cycle], records: &Records) -> bool {
        let [first, .., last] = cycles else { return true };
        let bins = records.drive.track.bins(first.half.start.time_s, last.half.end.time_s);
        let Some(fit) = Harmonic::fit(bins.clone(), self.frequency_rad_s, 0.0) else {
            return true;
        };
        let n = bins.clone().count() as f64;
        let square: f64 = bins.map(|bin| (bin.value - fit.at(bin.time_s)).powi(2)).sum();
        let allowed = OTHER_DRIVE * self.size + FOLLOWS * records.drive.sd();
        (fit.amplitude() - self.size).abs() <= allowed && (square / n).sqrt() <= allowed
    }
}
