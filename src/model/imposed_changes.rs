//! What each number does to a forced run: to the course, and to the moment that it takes.

use super::channel::{self, Tangent};
use super::course::N_COURSE;
use super::echo::{CourseEcho, Echo};
use super::effect::{Acts, Instant, MOST_LAGS};
use super::imposed::{Imposed, Remembered};
use super::lagging::{follow, jacobian};
use super::linear::{between, driven};
use super::number::{Sloped, slope};
use super::slopes;
use super::term::{Columns, N_BASE, Term};

/// Changes of the states of one term, column by column, at every point; nothing where still.
type Lagged = Vec<Option<Vec<[f64; MOST_LAGS]>>>;

/// What each number of a course does to roll, rate and acceleration at one instant.
type CourseChanges = [[f64; 3]; N_COURSE];

/// Numbers of the base equation that effects' equations name, the first of them.
const N_NAMED: usize = slope::PARAMETER - slope::BASE;

/// All that a forced run's changes are made of.
struct Changes<'a> {
    imposed: &'a Imposed<'a>,
    candidates: &'a [Term],
    /// States of every term that remembers.
    remembered: Remembered,
    /// Their changes.
    lagged: Vec<Lagged>,
    /// States of every candidate that remembers.
    followed: Vec<Vec<[f64; MOST_LAGS]>>,
    /// What the parameters of every term that is an echo do to it.
    heard: Vec<Vec<CourseEcho>>,
    /// What each strength of every candidate does where it is an echo.
    echoes: Vec<Vec<CourseEcho>>,
    /// Candidates with each strength moved a little in turn, and by how much.
    nudged: Vec<Vec<(Vec<f64>, f64)>>,
    n_columns: usize,
}

impl Imposed<'_> {
    /// What both channels read, with what each number does to it: course, base equation,
    /// parameters of the terms, strengths of the candidates.
    pub fn columns(&self, candidates: &[Term]) -> Columns {
        let changes = Changes::new(self, candidates);
        let is_through = [0, 1].map(|c| channel::is_read_through(self.terms, c));
        let courses = self.time_s.map(|time_s| -> Vec<CourseChanges> {
            time_s.iter().map(|t| self.course.changes(*t)).collect()
        });
        let instants = |c: usize| -> Vec<Instant<'_>> {
            let all = self.time_s[c].iter().zip(&courses[c]);
            let motion = |course| self.course.motion(course);
            all.map(|(t, course)| self.with_moment(*t, motion(course), &changes.remembered))
                .collect()
        };
        let needs_roll = is_through[0] || channel::is_read_through(candidates, 0);
        let seen = [if needs_roll { instants(0) } else { Vec::new() }, instants(1)];
        let roll = courses[0].iter().map(|course| self.course.motion(course)[0]).collect();
        let here = self.read(roll, [&seen[0], &seen[1]]);
        let n_roll = self.time_s[0].len();
        let mut columns = vec![vec![0.0; here.len()]; changes.n_columns];
        for (j, column) in columns[..N_COURSE].iter_mut().enumerate() {
            column.iter_mut().zip(&courses[0]).for_each(|(row, course)| *row = course[j][0]);
        }
        for (c, instants) in seen.iter().enumerate() {
            let (first, kind) = if c == 0 { (0, 0) } else { (n_roll, 3) };
            let mut tangents: Vec<Option<Vec<Tangent>>> = Vec::new();
            if is_through[c] {
                tangents = vec![Some(vec![[0.0; 4]; instants.len()]); changes.n_columns];
            }
            if is_through[c] || c == 1 {
                changes.each(instants, &courses[c], &mut |column, sample, tangent| {
                    columns[column][first + sample] = tangent[kind];
                    if let Some(Some(kept)) = tangents.get_mut(column) {
                        kept[sample] = tangent;
                    }
                });
            }
            if is_through[c] {
                let terms = self.terms;
                channel::add_tangents(terms, N_COURSE, c, instants, &tangents, &mut columns, first);
            }
            if !instants.is_empty() {
                channel::add_candidates(candidates, c, instants, &mut columns, first);
            }
        }
        Columns { here, columns }
    }
}

impl<'a> Changes<'a> {
    fn new(imposed: &'a Imposed<'a>, candidates: &'a [Term]) -> Self {
        let remembered = imposed.remembered();
        let n_parameters: usize = imposed.terms.iter().map(|term| term.values.len()).sum();
        let n_strengths: usize = candidates.iter().map(|c| c.effect.strengths.len()).sum();
        let n_columns = N_COURSE + N_BASE + n_parameters + n_strengths;
        let lags = |term: &&Term| matches!(term.effect.acts, Acts::Lagging(_));
        let shown = |term: &&Term| {
            matches!(term.effect.acts, Acts::Lagging(_)) && (term.effect.shows)(imposed.run)
        };
        let mut all = Self {
            imposed,
            candidates,
            remembered,
            lagged: Vec::new(),
            followed: Vec::new(),
            heard: Vec::new(),
            echoes: Vec::new(),
            nudged: candidates.iter().map(Term::nudged_each).collect(),
            n_columns,
        };
        let along = |echoes: Vec<Echo>| -> Vec<CourseEcho> {
            echoes
                .iter()
                .map(|echo| echo.of_course(imposed.course, imposed.run.rolled_for_s))
                .collect()
        };
        all.heard = imposed
            .terms
            .iter()
            .filter_map(|term| match term.effect.acts {
                Acts::Echo(taps) => Some(along(Echo::slopes(&taps, imposed.run, &term.values))),
                _ => None,
            })
            .collect();
        all.echoes = candidates
            .iter()
            .zip(&all.nudged)
            .map(|(term, nudged)| match term.effect.acts {
                Acts::Echo(taps) => along(
                    nudged
                        .iter()
                        .map(|(values, _)| Echo::new(&taps, imposed.run, values))
                        .collect(),
                ),
                _ => Vec::new(),
            })
            .collect();
        if !imposed.terms.iter().any(|term| lags(&term)) && !candidates.iter().any(|c| shown(&c)) {
            return all;
        }
        let points = &all.remembered.points;
        let instants: Vec<Instant<'_>> =
            points.times_s().map(|t| imposed.instant(t, imposed.course.at(t))).collect();
        all.lagged = all.lags_changed(&instants);
        let followed = candidates.iter().filter(shown).map(|term| match term.effect.acts {
            Acts::Lagging(lag) => {
                let start = imposed.lead.states(&lag, &term.values, imposed.run, imposed.base);
                follow(&lag, &term.values, start, &instants, points.step_s)
            }
            _ => Vec::new(),
        });
        all.followed = followed.collect();
        all
    }

    /// Changes of the states of every term that remembers.
    fn lags_changed(&self, instants: &[Instant<'_>]) -> Vec<Lagged> {
        if self.remembered.states.is_empty() {
            return Vec::new();
        }
        let step_s = self.remembered.points.step_s;
        let courses: Vec<CourseChanges> =
            instants.iter().map(|i| self.imposed.course.changes(i.time_s)).collect();
        let mut first = N_COURSE + N_BASE;
        let mut all = Vec::new();
        for Term { effect, values } in self.imposed.terms {
            let own = first..first + values.len();
            first = own.end;
            let Acts::Lagging(lag) = effect.acts else { continue };
            let states = &self.remembered.states[all.len()];
            let rows: Vec<[Sloped; MOST_LAGS]> = instants
                .iter()
                .zip(states)
                .map(|(i, states)| slopes::of_lag(&lag, &slopes::inputs(i), values, states).0)
                .collect();
            let jacobian = jacobian(&rows[0]);
            let named = N_COURSE..N_COURSE + N_NAMED;
            let Imposed { lead, run, base, .. } = self.imposed;
            let begun = lead.changes(&lag, values, run, base);
            let lagged = (0..self.n_columns).map(|column| {
                let forcing = |k: usize| -> [f64; MOST_LAGS] {
                    rows[k].map(|row| match column {
                        j if j < N_COURSE => along(&row, &courses[k][j]),
                        j if named.contains(&j) => row.slopes[slope::BASE + j - N_COURSE],
                        j => row.slopes[slope::PARAMETER + j - own.start],
                    })
                };
                let start = match column {
                    j if named.contains(&j) => begun[j - N_COURSE],
                    j if own.contains(&j) => begun[N_NAMED + j - own.start],
                    _ => [0.0; MOST_LAGS],
                };
                let moves = column < N_COURSE || own.contains(&column) || named.contains(&column);
                moves.then(|| driven(&jacobian, start, forcing, rows.len(), step_s))
            });
            all.push(lagged.collect());
        }
        all
    }

    /// The change with every column at every instant.
    fn each(
        &self,
        instants: &[Instant<'_>],
        courses: &[CourseChanges],
        tell: &mut dyn FnMut(usize, usize, Tangent),
    ) {
        let imposed = self.imposed;
        let (w, b1, b3) = (imposed.base.natural_rad_s, imposed.base.b1_per_s, imposed.base.b3_s);
        let (scale, points) = (imposed.scale(), &self.remembered.points);
        let mut sums = vec![0.0; self.n_columns];
        for (sample, (instant, course)) in instants.iter().zip(courses).enumerate() {
            let (roll, rate) = (instant.roll_rad, instant.rate_rad_per_s);
            let acceleration = instant.acceleration_rad_per_s2;
            sums.fill(0.0);
            let sloped = slopes::inputs(instant);
            let mut whole = [w * w, b1 + 3.0 * b3 * rate * rate, 1.0];
            let (mut first, mut lag_place) = (N_COURSE + N_BASE, 0);
            let mut heard = self.remembered.echoes.iter().zip(&self.heard);
            for Term { effect, values } in imposed.terms {
                let own = first..first + values.len();
                first = own.end;
                let (of, by) = match effect.acts {
                    Acts::Moment(law) => (slopes::of_law(&law, &sloped, values), -1.0),
                    Acts::Echo(_) => {
                        if let Some((echo, slopes)) = heard.next() {
                            let changes = echo.changes(imposed.course, instant.time_s);
                            sums.iter_mut().zip(changes).for_each(|(sum, of)| *sum -= of);
                            for (column, slope) in own.clone().zip(slopes) {
                                sums[column] -= slope.at(imposed.course, instant.time_s);
                            }
                        }
                        continue;
                    }
                    Acts::Inertia(law) => {
                        let of = slopes::of_law(&law, &sloped, values);
                        whole[2] += of.value;
                        (of, acceleration)
                    }
                    Acts::Lagging(lag) => {
                        let place = points.place(instant.time_s);
                        let states = between(&self.remembered.states[lag_place], place);
                        let (_, of) = slopes::of_lag(&lag, &sloped, values, &states);
                        for (sum, lagged) in sums.iter_mut().zip(&self.lagged[lag_place]) {
                            let change = lagged.as_ref().map(|points| between(points, place));
                            for (k, change) in change.iter().flatten().enumerate() {
                                *sum -= of.slopes[slope::REMEMBERED + k] * change;
                            }
                        }
                        lag_place += 1;
                        (of, -1.0)
                    }
                    Acts::Roll(_) | Acts::Drive(_) | Acts::Chain(..) | Acts::Record(_) => continue,
                };
                let motion = [slope::ROLL, slope::RATE, slope::ACCELERATION];
                whole.iter_mut().zip(motion).for_each(|(whole, k)| *whole += by * of.slopes[k]);
                for k in 0..N_NAMED {
                    sums[N_COURSE + k] += by * of.slopes[slope::BASE + k];
                }
                for (k, column) in own.enumerate() {
                    sums[column] += by * of.slopes[slope::PARAMETER + k];
                }
            }
            for (sum, change) in sums.iter_mut().zip(course) {
                *sum += whole[0] * change[0] + whole[1] * change[1] + whole[2] * change[2];
            }
            let all = instant.moment_n_m / scale;
            let of_base = [2.0 * (w * roll - all / w), rate, rate.powi(3), all];
            sums[N_COURSE..].iter_mut().zip(of_base).for_each(|(sum, of_base)| *sum += of_base);
            self.push(instant, &mut sums[first..]);
            for (column, sum) in sums.iter().enumerate() {
                let [roll, rate, acceleration] = course.get(column).copied().unwrap_or_default();
                tell(column, sample, [roll, rate, acceleration, scale * sum]);
            }
        }
    }

    /// What each candidate strength does to the moment per unit inertia.
    fn push(&self, instant: &Instant<'_>, sums: &mut [f64]) {
        let mut next = 0;
        let mut followed = self.followed.iter();
        let each = self.candidates.iter().zip(&self.nudged).zip(&self.echoes);
        for ((candidate, nudged), echoes) in each {
            let shows = (candidate.effect.shows)(instant.run);
            let states = match candidate.effect.acts {
                Acts::Lagging(_) if shows => followed.next().map_or([0.0; MOST_LAGS], |states| {
                    between(states, self.remembered.points.place(instant.time_s))
                }),
                _ => [0.0; MOST_LAGS],
            };
            for (k, (values, by)) in nudged.iter().enumerate() {
                if shows {
                    sums[next] += match candidate.effect.acts {
                        Acts::Moment(law) => -(law.plain)(instant, values) / by,
                        Acts::Echo(_) => -echoes[k].at(self.imposed.course, instant.time_s) / by,
                        Acts::Inertia(law) => {
                            instant.acceleration_rad_per_s2 * (law.plain)(instant, values) / by
                        }
                        Acts::Lagging(lag) => -(lag.moment.plain)(instant, values, &states) / by,
                        Acts::Roll(_) | Acts::Drive(_) | Acts::Chain(..) | Acts::Record(_) => 0.0,
                    };
                }
                next += 1;
            }
        }
    }
}

/// What a change of the motion does to a number of known slopes.
fn along(of: &Sloped, motion: &[f64; 3]) -> f64 {
    of.slopes[slope::ROLL] * motion[0]
        + of.slopes[slope::RATE] * motion[1]
        + of.slopes[slope::ACCELERATION] * motion[2]
}
