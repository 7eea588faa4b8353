//! Refuses numbers that no model test has and only a wrong unit makes.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use super::estimate::Estimate;
use super::forced::response::SteadyResponse;
use crate::run::Run;

/// Damping ratios of a rolling model [-]: a round bare hull has about 0.005, large keels at speed
/// 0.3; a force that is wrong by a factor of 1000 leaves the range from anywhere between.
const DAMPING_RATIO: RangeInclusive<f64> = 0.0005..=2.0;
/// Frequencies of forced rolling as a share of the natural one [-], with a wide margin.
const FREQUENCY_SHARE: RangeInclusive<f64> = 0.1..=10.0;

/// Refuses a roll that turns a model over.
pub(super) fn roll(run: &Run) -> Result<(), String> {
    let (low, high) = bounds(run);
    let amplitude_rad = 0.5 * (high - low);
    if amplitude_rad > FRAC_PI_2 {
        return Err(format!(
            "the roll has an amplitude of {:.0} deg, above 90 deg (hint: the unit of roll in \
             [columns])",
            amplitude_rad.to_degrees()
        ));
    }
    Ok(())
}

/// Steps of a converter that the roll must move over: below this its shape is the converter's.
const N_QUANTA: f64 = 8.0;

/// Refuses a roll that moves over a few steps of its channel only.
pub(super) fn resolution(run: &Run, quantum_rad: Option<f64>) -> Result<(), String> {
    let Some(quantum_rad) = quantum_rad else { return Ok(()) };
    let (low, high) = bounds(run);
    let n_quanta = ((high - low) / quantum_rad).round();
    if n_quanta >= N_QUANTA {
        return Ok(());
    }
    Err(format!(
        "the roll moves over {n_quanta} steps of {:.3} deg of its channel, {N_QUANTA} are needed \
         (hint: a finer range of the converter, or a larger heel)",
        quantum_rad.to_degrees()
    ))
}

/// Intervals of the drive that are a hole when they are missing in a row [-].
const HOLE_INTERVALS: f64 = 5.0;
/// Share of a half period of the excitation that a line between two samples still follows [-].
const HOLE_SHARE: f64 = 0.25;

/// Refuses a drive with a hole: between its ends nobody knows what the rod did.
pub(super) fn drive(run: &Run) -> Result<(), String> {
    let times_s = &run.drive.time_s;
    let mut intervals_s: Vec<f64> = times_s.windows(2).map(|two| two[1] - two[0]).collect();
    intervals_s.sort_by(f64::total_cmp);
    let Some(typical_s) = intervals_s.get(intervals_s.len() / 2) else { return Ok(()) };
    let half_s = run.excitation_rad_s.map_or(0.0, |rad_s| std::f64::consts::PI / rad_s);
    let limit_s = (HOLE_INTERVALS * typical_s).max(HOLE_SHARE * half_s);
    let hole = times_s.windows(2).find(|two| two[1] - two[0] > limit_s);
    hole.map_or(Ok(()), |two| {
        Err(format!(
            "the force has a hole of {:.3} s after {:.3} s, {limit_s:.3} s can be bridged",
            two[1] - two[0],
            two[0]
        ))
    })
}

fn bounds(run: &Run) -> (f64, f64) {
    let bound = |pick: fn(f64, f64) -> f64| run.roll.value.iter().copied().reduce(pick);
    (bound(f64::min).unwrap_or(0.0), bound(f64::max).unwrap_or(0.0))
}

/// Refuses a moment that does not belong to the motion.
pub(super) fn response(
    response: &SteadyResponse,
    restoring_n_m_per_rad: f64,
) -> Result<(), String> {
    let inertia = response.inertia_kg_m2.mean;
    let damping_per_s = response.work_damping_n_m_s.scaled(1.0 / inertia);
    driven(inertia, restoring_n_m_per_rad, response.roll.frequency_rad_s.mean, &damping_per_s)
}

/// Refuses an inertia [kg m2] or an equivalent damping [1/s] that no model has, where it swings at
/// `frequency_rad_s` [rad/s].
pub(super) fn driven(
    inertia_kg_m2: f64,
    restoring_n_m_per_rad: f64,
    frequency_rad_s: f64,
    damping_per_s: &Estimate,
) -> Result<(), String> {
    let natural_rad_s = (restoring_n_m_per_rad / inertia_kg_m2).sqrt();
    let share = frequency_rad_s / natural_rad_s;
    if !FREQUENCY_SHARE.contains(&share) {
        return Err(format!(
            "an inertia of {inertia_kg_m2:.3} kg m2 puts the excitation at {share:.2} times the \
             natural frequency, outside {} to {} ({WRONG_UNIT})",
            FREQUENCY_SHARE.start(),
            FREQUENCY_SHARE.end()
        ));
    }
    let ratio = |damping_per_s: f64| damping_per_s / (2.0 * natural_rad_s);
    // The band counts: noise may well hide the work of a rod that was weak.
    if ratio(damping_per_s.hi95) < *DAMPING_RATIO.start()
        || ratio(damping_per_s.lo95) > *DAMPING_RATIO.end()
    {
        return Err(format!(
            "the work of the rod makes a damping ratio of {:.2e}, outside {} to {} ({WRONG_UNIT})",
            ratio(damping_per_s.mean),
            DAMPING_RATIO.start(),
            DAMPING_RATIO.end()
        ));
    }
    Ok(())
}

const WRONG_UNIT: &str = "hint: the units of force and roll in [columns], moment_arm_m, gm_m";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{RunEnd, RunKind, Series, Timing};

    fn forced(missing: std::ops::Range<usize>) -> Run {
        let kept = (0..2000).filter(|k| !missing.contains(k));
        let time_s: Vec<f64> = kept.map(|k| f64::from(k as u32) * 0.01).collect();
        let value = time_s.iter().map(|time_s| (5.0 * time_s).sin()).collect();
        Run {
            kind: RunKind::Forced,
            start_s: 0.0,
            end_s: 20.0,
            end: RunEnd::ExcitationChanged,
            speed_m_s: None,
            roll: Series::default(),
            drive: Series { time_s, value },
            speed: Series::default(),
            lead: Series::default(),
            still: None,
            excitation_rad_s: Some(5.0),
            timing: Timing::default(),
        }
    }

    #[test]
    fn a_force_with_a_hole_is_refused_and_one_that_lacks_a_few_samples_is_not() {
        assert_eq!(drive(&forced(0..0)), Ok(()));
        assert_eq!(drive(&forced(700..714)), Ok(()));
        let refused = drive(&forced(700..780)).unwrap_err();
        assert!(refused.contains("a hole of 0.810 s after 6.990 s, 0.157 s can"), "{refused}");
    }
}
