//! What the measuring chain makes of a motion, sample by sample, and of small changes of it.

use std::array;

use super::effect::{Acts, Instant, Law, Reading};
use super::number::{N_SLOPES, Sloped};
use super::term::{N_BASE, Term};

/// Change of roll, rate, acceleration and moment with one number.
pub(super) type Tangent = [f64; 4];

/// Whether an effect acts on what channel 0, the roll, or channel 1, the moment, reads.
fn acts_on(term: &Term, channel: usize) -> bool {
    match term.effect.acts {
        Acts::Roll(_) => channel == 0,
        Acts::Drive(_) => channel == 1,
        Acts::Chain(..) => true,
        _ => false,
    }
}

/// Whether some effect acts on what a channel reads.
pub(super) fn is_read_through(terms: &[Term], channel: usize) -> bool {
    terms.iter().any(|term| acts_on(term, channel))
}

/// The law by which an effect adds to a channel, value by value.
fn law_of(term: &Term, channel: usize) -> Option<Law> {
    match term.effect.acts {
        Acts::Drive(law) if channel == 1 => Some(law),
        _ => None,
    }
}

/// The law by which an effect adds to all values of a channel.
fn reading_of(term: &Term, channel: usize) -> Option<Reading> {
    match term.effect.acts {
        Acts::Roll(reading) if channel == 0 => Some(reading),
        Acts::Chain(roll, moment) => Some(if channel == 0 { roll } else { moment }),
        _ => None,
    }
}

/// What an effect adds to the readings of a channel.
fn added(term: &Term, channel: usize, values: &[f64], instants: &[Instant<'_>]) -> Vec<f64> {
    if let Some(law) = law_of(term, channel) {
        return instants.iter().map(|i| (law.plain)(i, values)).collect();
    }
    reading_of(term, channel).map_or_else(Vec::new, |reading| (reading.plain)(instants, values))
}

/// Adds what the effects on a channel add to its readings.
pub(super) fn add(terms: &[Term], channel: usize, instants: &[Instant<'_>], readings: &mut [f64]) {
    for term in terms.iter().filter(|term| acts_on(term, channel)) {
        let added = added(term, channel, &term.values, instants);
        readings.iter_mut().zip(added).for_each(|(reading, more)| *reading += more);
    }
}

/// Writes what candidates on a channel would add, per unit of each strength, into the last
/// columns, from row `first`.
pub(super) fn add_candidates(
    candidates: &[Term],
    channel: usize,
    instants: &[Instant<'_>],
    columns: &mut [Vec<f64>],
    first: usize,
) {
    let n: usize = candidates.iter().map(|c| c.effect.strengths.len()).sum();
    let mut column = columns.len() - n;
    for candidate in candidates {
        for (values, step) in candidate.nudged_each() {
            let is_shown = instants.first().is_some_and(|i| (candidate.effect.shows)(i.run));
            if is_shown && acts_on(candidate, channel) {
                let added = added(candidate, channel, &values, instants);
                let rows = columns[column][first..].iter_mut();
                rows.zip(added).for_each(|(row, more)| *row += more / step);
            }
            column += 1;
        }
    }
}

/// Adds what the effects on a channel make of changes of the motion and of their own parameters,
/// a few columns at a time, from row `first`; `n_own` columns come before the base equation's.
pub(super) fn add_tangents(
    terms: &[Term],
    n_own: usize,
    channel: usize,
    instants: &[Instant<'_>],
    tangents: &[Option<Vec<Tangent>>],
    columns: &mut [Vec<f64>],
    first: usize,
) {
    for from in (0..columns.len()).step_by(N_SLOPES) {
        let here = from..(from + N_SLOPES).min(columns.len());
        let along = |value: f64, sample: usize, kind: usize| -> Sloped {
            let slopes = array::from_fn(|lane| {
                let tangent = tangents.get(from + lane).and_then(Option::as_ref);
                tangent.map_or(0.0, |tangent| tangent[sample][kind])
            });
            Sloped { value, slopes }
        };
        let input = |value: f64, column: usize| -> Sloped {
            if here.contains(&column) { Sloped::input(value, column - from) } else { value.into() }
        };
        let sloped: Vec<Instant<'_, Sloped>> = instants
            .iter()
            .enumerate()
            .map(|(sample, i)| Instant {
                time_s: i.time_s,
                roll_rad: along(i.roll_rad, sample, 0),
                rate_rad_per_s: along(i.rate_rad_per_s, sample, 1),
                acceleration_rad_per_s2: along(i.acceleration_rad_per_s2, sample, 2),
                moment_n_m: along(i.moment_n_m, sample, 3),
                natural_rad_s: input(i.natural_rad_s, n_own),
                b1_per_s: input(i.b1_per_s, n_own + 1),
                run: i.run,
            })
            .collect();
        let mut parameter = n_own + N_BASE;
        for term in terms {
            let values: Vec<Sloped> = (parameter..)
                .zip(&term.values)
                .map(|(column, value)| input(*value, column))
                .collect();
            parameter += term.values.len();
            let added: Vec<Sloped> = match (law_of(term, channel), reading_of(term, channel)) {
                (Some(law), _) => sloped.iter().map(|i| (law.sloped)(i, &values)).collect(),
                (None, Some(reading)) => (reading.sloped)(&sloped, &values),
                (None, None) => continue,
            };
            for column in here.clone() {
                let rows = columns[column][first..].iter_mut();
                rows.zip(&added).for_each(|(row, more)| *row += more.slopes[column - from]);
            }
        }
    }
}
