//! Numbers of the base equation and of the effects that act in one run.

use super::effect::Effect;

/// The base equation of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// Natural frequency [rad/s].
    pub natural_rad_s: f64,
    /// Linear damping [1/s].
    pub b1_per_s: f64,
    /// Cubic damping [s].
    pub b3_s: f64,
    /// Logarithm of the measured moment's scale: restoring, arm and gains together [-].
    pub log_scale: f64,
}

/// One effect with its numbers in one run.
#[derive(Debug, Clone)]
pub struct Term {
    /// The effect.
    pub effect: &'static Effect,
    /// Strengths, then shapes.
    pub values: Vec<f64>,
}

/// Numbers of the base equation.
pub const N_BASE: usize = 4;

/// What channels read, and what each number of a model does to the readings.
#[derive(Debug, Clone)]
pub struct Columns {
    /// Readings, one channel after the other.
    pub here: Vec<f64>,
    /// Change of all readings with each number: those of the start or course, of the base
    /// equation, parameters of the terms, strengths of the candidates.
    pub columns: Vec<Vec<f64>>,
}

/// Share of the typical size by which a candidate's strength is moved from nil to see what it does.
const SMALL: f64 = 1e-3;

impl Term {
    /// The values with each strength in turn moved a little from where it stands, and by how much.
    pub(super) fn nudged_each(&self) -> Vec<(Vec<f64>, f64)> {
        let nudged = |k: usize| {
            let step = SMALL * self.effect.strengths[k].typical;
            let mut values = self.values.clone();
            values[k] += step;
            (values, step)
        };
        (0..self.effect.strengths.len()).map(nudged).collect()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::model::course::{Course, N_COURSE};
    use crate::model::effect::Instant;
    use crate::model::effects;
    use crate::model::free::{Decay, n_stirred};
    use crate::model::imposed::Imposed;
    use crate::model::lead::Lead;
    use crate::model::{Acts, Circumstances};
    use crate::run::RunKind;

    /// Some run of a kind, in a tank of unknown width.
    pub(in crate::model) fn run(kind: RunKind) -> Circumstances {
        Circumstances {
            kind,
            froude: 0.2,
            speed_m_s: 0.4,
            natural_rad_s: 6.9,
            b1_per_s: 0.4,
            inertia_kg_m2: 1.7,
            amplitude_rad: 0.2,
            rolling_rad_s: 6.9,
            span_s: 12.0,
            gravity_m_s2: 9.81,
            clear_width_m: None,
            section: None,
            sample_rate_hz: 50.0,
            order: 0,
            has_moment: true,
            n_runs: 6,
            initial_roll_rad: 0.2,
            rolled_for_s: 3.0,
            since_rest_s: 5.0,
        }
    }

    /// Start or course, then the base equation, then the parameters of the term.
    fn numbers(kind: RunKind, term: Option<&Term>) -> Vec<f64> {
        let mut numbers = match kind {
            RunKind::Decay => [
                vec![0.2, -0.1],
                vec![0.03; term.map_or(0, |term| n_stirred(std::slice::from_ref(term)))],
            ]
            .concat(),
            RunKind::Forced => vec![0.01, 0.15, -0.05, 0.002, 0.001, -0.003, 0.004, 5.9],
        };
        numbers.extend([6.8, 0.38, 0.15, 0.02]);
        numbers.extend(term.into_iter().flat_map(|term| &term.values));
        numbers
    }

    /// Heeling the model within a second, three seconds before its release.
    fn lead() -> Lead {
        let times: Vec<f64> = (0..600).map(|k| -6.0 + 0.01 * f64::from(k)).collect();
        let rolls: Vec<f64> = times.iter().map(|t| 0.2 * (t + 4.0).clamp(0.0, 1.0)).collect();
        Lead::new(&times, &rolls, 6.9)
    }

    /// A run's instants in a steady swing `phi = sin w t` with the moment `cos w t` [N m].
    pub(in crate::model) fn swing(run: &Circumstances, n: u32, step_s: f64) -> Vec<Instant<'_>> {
        let rad_s = run.rolling_rad_s;
        let at = |k| {
            let time_s = f64::from(k) * step_s;
            let (sin, cos) = (rad_s * time_s).sin_cos();
            Instant {
                time_s,
                roll_rad: sin,
                rate_rad_per_s: rad_s * cos,
                acceleration_rad_per_s2: -rad_s * rad_s * sin,
                moment_n_m: cos,
                natural_rad_s: rad_s,
                b1_per_s: run.b1_per_s,
                run,
            }
        };
        (0..n).map(at).collect()
    }

    /// Readings and columns under the numbers.
    fn columns(kind: RunKind, term: Option<&Term>, numbers: &[f64], tried: &[Term]) -> Columns {
        let run = run(kind);
        let n_own = numbers.len() - N_BASE - term.map_or(0, |term| term.values.len());
        let of_base = &numbers[n_own..];
        let base = Base {
            natural_rad_s: of_base[0],
            b1_per_s: of_base[1],
            b3_s: of_base[2],
            log_scale: of_base[3],
        };
        let values = of_base[N_BASE..].to_vec();
        let terms: Vec<Term> =
            term.iter().map(|term| Term { effect: term.effect, values: values.clone() }).collect();
        let times: Vec<f64> = (0..400).map(|k| 0.03 * f64::from(k)).collect();
        let time_s = [&times[..], &times[..]];
        let (run, base, terms) = (&run, &base, &terms[..]);
        if kind == RunKind::Decay {
            let (start, stirred) = ([numbers[0], numbers[1]], &numbers[2..n_own]);
            return Decay { run, base, terms, start, lead: &lead(), stirred, time_s }
                .columns(tried);
        }
        let mut course = Course { numbers: [0.0; N_COURSE] };
        course.numbers.copy_from_slice(&numbers[..N_COURSE]);
        Imposed { run, base, terms, course: &course, lead: &lead(), time_s }.columns(tried)
    }

    fn rms(values: impl Iterator<Item = f64>) -> f64 {
        values.map(|v| v * v).sum::<f64>().sqrt()
    }

    /// Every effect that moves a reading, somewhere in its range.
    fn every_term(run: &Circumstances) -> Vec<Term> {
        let moves = |effect: &&'static Effect| {
            (effect.shows)(run) && !matches!(effect.acts, Acts::Record(_))
        };
        let all = effects::all().iter().filter(moves).map(|effect| {
            let mut values: Vec<f64> = effect.strengths.iter().map(|p| 0.7 * p.typical).collect();
            values.extend(&(effect.nodes)(run)[0]);
            Term { effect, values }
        });
        all.collect()
    }

    #[test]
    fn each_number_does_to_the_readings_what_moving_it_does() {
        for kind in [RunKind::Decay, RunKind::Forced] {
            let terms = every_term(&run(kind));
            assert!(terms.len() > 25, "{}", terms.len());
            for term in terms.iter().map(Some).chain([None]) {
                let numbers = numbers(kind, term);
                let Columns { here, columns: told } = columns(kind, term, &numbers, &[]);
                assert_eq!(told.len(), numbers.len());
                for (k, told) in told.iter().enumerate() {
                    let step = 1e-5 * numbers[k].abs().max(0.01);
                    let moved = |by: f64| {
                        let mut moved = numbers.clone();
                        moved[k] += by;
                        columns(kind, term, &moved, &[]).here
                    };
                    let slopes: Vec<f64> = moved(step)
                        .iter()
                        .zip(moved(-step))
                        .map(|(above, below)| (above - below) / (2.0 * step))
                        .collect();
                    // What does next to nothing need not be known to a share of itself.
                    let least = 0.01 * rms(here.iter().copied()) / numbers[k].abs().max(0.01);
                    let whole = rms(slopes.iter().copied()).max(least);
                    let off = rms(slopes.iter().zip(told).map(|(s, t)| s - t)) / whole;
                    let id = term.map_or("base", |term| term.effect.id);
                    // Where an effect has corners, moving a number moves them between steps.
                    assert!(off < 0.01, "{id}, {kind:?}, number {k}: off by {off:.5}");
                }
            }
        }
    }

    #[test]
    fn each_candidate_does_what_a_little_of_it_does() {
        for kind in [RunKind::Decay, RunKind::Forced] {
            let numbers = numbers(kind, None);
            for mut tried in every_term(&run(kind)) {
                let n_strengths = tried.effect.strengths.len();
                tried.values[..n_strengths].fill(0.0);
                let without = columns(kind, None, &numbers, std::slice::from_ref(&tried));
                let told = &without.columns[without.columns.len() - n_strengths..];
                for ((values, by), told) in tried.nudged_each().into_iter().zip(told) {
                    let with = Term { effect: tried.effect, values };
                    let mut numbers = self::numbers(kind, Some(&with));
                    if kind == RunKind::Decay {
                        // A candidate is tried as if nothing had been stirred.
                        numbers[2..2 + n_stirred(std::slice::from_ref(&with))].fill(0.0);
                    }
                    let there = columns(kind, Some(&with), &numbers, &[]).here;
                    let slopes: Vec<f64> =
                        there.iter().zip(&without.here).map(|(t, n)| (t - n) / by).collect();
                    let off = rms(slopes.iter().zip(told).map(|(s, t)| s - t));
                    // What does nothing in such a run must say so.
                    let all = rms(slopes.iter().copied());
                    assert!(off <= 0.02 * all, "{}, {kind:?}: off by {off}", tried.effect.id);
                }
            }
        }
    }

    #[test]
    fn a_course_that_runs_away_is_answered() {
        let run = run(RunKind::Forced);
        for frequency_rad_s in [f64::INFINITY, f64::NAN, 1e300, 1e9, 0.0, -6.9] {
            let mut numbers = numbers(RunKind::Forced, None);
            numbers[N_COURSE - 1] = frequency_rad_s;
            for term in every_term(&run) {
                let all = [&numbers[..], &term.values].concat();
                assert_eq!(columns(RunKind::Forced, Some(&term), &all, &[]).here.len(), 800);
            }
        }
    }
}
