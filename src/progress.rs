//! How far the test plan has come: which of the runs found it asked for, which is next.

use serde::Serialize;

use crate::campaign::{Campaign, PlannedRuns};
use crate::results::IdentifiedRun;
use crate::run::RunKind;

/// Froude numbers further apart than this [-] are not of one row.
const FROUDE_NEAR: f64 = 0.01;
/// Amplitudes that differ by more than this share, and by more than `AMPLITUDE_NEAR_DEG`, are not
/// of one row: a hand heels a model to a degree or two.
const AMPLITUDE_NEAR: f64 = 0.2;
/// See `AMPLITUDE_NEAR` [deg].
const AMPLITUDE_NEAR_DEG: f64 = 1.0;
/// Frequencies that differ by more than this share are not of one row.
const FREQUENCY_NEAR: f64 = 0.02;

/// The plan with what is done of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Progress {
    /// Rows in the order of the plan.
    pub rows: Vec<RowProgress>,
    /// Index of the first row that lacks a run; none when the plan is done, or empty.
    pub next: Option<usize>,
    /// Runs asked for.
    pub n_asked: usize,
    /// Runs done of those asked for.
    pub n_done: usize,
    /// Ids of the runs that no row asks for.
    pub unplanned: Vec<String>,
}

/// One row of the plan with its runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowProgress {
    /// Loading or appendage condition.
    pub condition: String,
    /// Froude number [-].
    pub froude: f64,
    /// Carriage speed [m/s].
    pub speed_m_s: f64,
    /// "decay" or "forced".
    pub kind: &'static str,
    /// Amplitude [deg], where the plan tells one.
    pub amplitude_deg: Option<f64>,
    /// Frequency of the excitation [rad/s] of a forced run.
    pub frequency_rad_s: Option<f64>,
    /// Runs asked for.
    pub asked: usize,
    /// Ids of the runs that fit; there may be more than were asked for.
    pub done: Vec<String>,
}

impl RowProgress {
    /// Runs that are still to be made.
    pub fn n_missing(&self) -> usize {
        self.asked.saturating_sub(self.done.len())
    }

    /// What is asked for, in words: "decay from 15 deg at Fr 0.200 (0.99 m/s), bare hull".
    pub fn words(&self) -> String {
        let Self { condition, froude, speed_m_s, kind, .. } = self;
        let from = if self.frequency_rad_s.is_some() { "to" } else { "from" };
        let amplitude = self.amplitude_deg.map(|deg| format!(" {from} {deg:.1} deg"));
        let frequency = self.frequency_rad_s.map(|rad_s| format!(" with {rad_s:.3} rad/s"));
        let what = [amplitude, frequency].into_iter().flatten().collect::<String>();
        format!("{kind}{what} at Fr {froude:.3} ({speed_m_s:.2} m/s), {condition}")
    }
}

/// The progress of the campaign's plan with these runs.
///
/// A run counts for the row that it fits best: condition and kind alike, Froude number within 0.01,
/// amplitude within 20 % or 1 deg, frequency within 2 %. Of rows that lack runs and rows that are
/// full, it goes to one that lacks.
pub fn progress<'r>(
    campaign: &Campaign,
    runs: impl IntoIterator<Item = &'r IdentifiedRun>,
) -> Progress {
    let mut rows: Vec<RowProgress> =
        campaign.plan.rows.iter().map(|planned| row(campaign, planned)).collect();
    let mut unplanned = Vec::new();
    for run in runs {
        let fits = campaign.plan.rows.iter().enumerate();
        let best = fits
            .filter_map(|(index, planned)| {
                Some((rows[index].n_missing() == 0, distance(planned, run)?, index))
            })
            .min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        match best {
            Some((_, _, index)) => rows[index].done.push(run.id.clone()),
            None => unplanned.push(run.id.clone()),
        }
    }
    Progress {
        next: rows.iter().position(|row| row.n_missing() > 0),
        n_asked: rows.iter().map(|row| row.asked).sum(),
        n_done: rows.iter().map(|row| row.asked - row.n_missing()).sum(),
        rows,
        unplanned,
    }
}

fn row(campaign: &Campaign, planned: &PlannedRuns) -> RowProgress {
    RowProgress {
        condition: planned.condition.clone(),
        froude: planned.froude,
        speed_m_s: campaign.hull.speed_m_s(planned.froude, &campaign.water),
        kind: planned.kind.name(),
        amplitude_deg: planned.amplitude_rad.map(f64::to_degrees),
        frequency_rad_s: planned.frequency_rad_s,
        asked: planned.repeats,
        done: Vec::new(),
    }
}

/// How far a run is from what a row asks for, in tolerances; none when it is beyond one.
fn distance(planned: &PlannedRuns, run: &IdentifiedRun) -> Option<f64> {
    if run.condition != planned.condition || run.run.kind != planned.kind {
        return None;
    }
    let apart_froude = (run.froude - planned.froude) / FROUDE_NEAR;
    let apart_amplitude = planned.amplitude_rad.map_or(0.0, |asked_rad| {
        let near_rad = (AMPLITUDE_NEAR * asked_rad).max(AMPLITUDE_NEAR_DEG.to_radians());
        (amplitude_rad(run) - asked_rad) / near_rad
    });
    let apart_frequency = match planned.frequency_rad_s {
        None => 0.0,
        Some(asked_rad_s) => {
            let forced = run.identification.forced.as_ref()?;
            (forced.frequency_rad_s.mean / asked_rad_s - 1.0) / FREQUENCY_NEAR
        }
    };
    let apart = [apart_froude, apart_amplitude, apart_frequency];
    let near = apart.iter().all(|share| share.abs() <= 1.0);
    near.then(|| apart.iter().map(|share| share * share).sum())
}

/// Heel at the release, or amplitude of the forced roll [rad].
fn amplitude_rad(run: &IdentifiedRun) -> f64 {
    let forced = run.identification.forced.as_ref().filter(|_| run.run.kind == RunKind::Forced);
    let roll = forced.map_or(run.identification.initial_roll_rad, |at| at.roll_amplitude_rad);
    roll.mean.abs()
}
